"""Python package of this catkin package, for catkin_python_setup(); do not call it by hand."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

PACKAGE = "spherical_actuator_calibration"

setup(
    **generate_distutils_setup(
        packages=[PACKAGE] + [f"{PACKAGE}.{part}" for part in ("coil_drive", "report_page", "session_guide", "session_tables")],
        package_dir={"": "src"},
        package_data={f"{PACKAGE}.report_page": ["report_style.css", "report_template.html"]},
    )
)
