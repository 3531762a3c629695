from click.testing import CliRunner

from gapless import _numba
from gapless.cli import gapless

_numba._said.add("compiling")  # whether kernels are there is the machine's affair, not a test's


COMPILING = "gapless: compiling kernels, once per version (about ten seconds)\n"


class Shell:
    """Runs the command line in this process."""

    def __call__(self, *words, code=0):
        wide = {"COLUMNS": "140"}  # whatever terminal the tests are run in
        result = CliRunner().invoke(gapless, [str(word) for word in words], prog_name="gapless", env=wide)
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        assert result.exit_code == code, result.output
        return result
