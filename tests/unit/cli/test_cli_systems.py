"""What `gapless systems` says of each: of what it is made, and of nothing else."""

from gapless.cli.systems import made_of
from gapless.systems.adjust import named


def test_a_bridge_without_a_learner_names_none():
    assert made_of(named("wheels")).endswith("; wheels")
    assert made_of(named("auto")).endswith("; rehearsed every 20 s; wheels")
    assert made_of(named("constraints")).endswith("; no bridge")
    assert "-> position increment" in made_of(named("tan2015"))
