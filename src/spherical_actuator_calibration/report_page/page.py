"""The page as a whole: the template filled with the content of a report."""

import os

import jinja2

from .content import Report

TEMPLATE = "report_template.html"


def render_page(report, previous=None):
    """HTML of the page, one file that needs no other; with what changed since a previous report of the unit."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(os.path.dirname(os.path.abspath(__file__))),
        # Names come from descriptions and recordings: nothing in them is markup.
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(TEMPLATE).render(report=Report(report, previous))
