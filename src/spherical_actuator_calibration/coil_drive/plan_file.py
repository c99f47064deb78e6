"""Motion plans as files."""

from ..text_files import LARGEST_CONFIGURATION, TextFileError, parsed_yaml, read_text


def read_motion_plan(path):
    """Text of a plan of plan_motion; what is in it is judged by who follows it. Raises TextFileError."""
    text = read_text(path, LARGEST_CONFIGURATION)
    content = parsed_yaml(text, path)
    if not isinstance(content, dict) or not isinstance(content.get("motion_plan"), dict):
        raise TextFileError(f"{path}: this is no plan of plan_motion: the key motion_plan is missing.")
    return text
