"""The page as a whole: the template filled with the content of a report."""

import os

import jinja2

from report_page.content import Report

TEMPLATE = "report_template.html"
PACKAGE = "spherical_actuator_calibration"


def _template_folders():
    """In a source folder share/ lies beside scripts/; installed, share/<package> beside lib/<package>."""
    programs = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
    return [
        os.path.join(programs, os.pardir, "share"),
        os.path.join(programs, os.pardir, os.pardir, "share", PACKAGE),
    ]


def render_page(report):
    """HTML of the page, one file that needs no other."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_template_folders()),
        # Names come from descriptions and recordings: nothing in them is markup.
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(TEMPLATE).render(report=Report(report))
