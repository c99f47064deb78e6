"""Programs of scripts/ within a test's own process, which is quicker than to start them."""

import importlib.machinery
import importlib.util
import os
import pathlib


def loaded(name):
    """A program as a module."""
    path = pathlib.Path(os.environ["SOURCE"]) / "scripts" / name
    loader = importlib.machinery.SourceFileLoader(name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module
