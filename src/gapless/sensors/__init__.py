"""The error model of an IMU: grades as data, corrupt and correct, Allan deviation."""

from gapless.sensors.allan import AllanReading, allan_deviation, read_allan
from gapless.sensors.grades import Grade, grade, grade_names, parse_grade
from gapless.sensors.imu_errors import ImuErrors, correct, corrupt
from gapless.sensors.noise import band_limited, gauss_markov, random_walk

__all__ = [
    "AllanReading",
    "Grade",
    "ImuErrors",
    "allan_deviation",
    "band_limited",
    "correct",
    "corrupt",
    "gauss_markov",
    "grade",
    "grade_names",
    "parse_grade",
    "random_walk",
    "read_allan",
]
