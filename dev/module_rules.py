"""How the modules in Python use each other, for dev/check_rooms: in no circle, and found where they are installed."""

import ast
import re

import room_picture

PACKAGE = room_picture.PACKAGE


def circles_of(uses, of_what):
    """Circles in a graph."""
    done, way = set(), []

    def follow(unit):
        if unit in way:
            yield f"circle of {of_what}: " + " -> ".join([*way[way.index(unit) :], unit])
        elif unit not in done:
            way.append(unit)
            for used in sorted(uses.get(unit, ())):
                yield from follow(used)
            way.pop()
            done.add(unit)

    for unit in sorted(uses):
        yield from follow(unit)


def imported_names(file, text):
    """What a module or program in Python imports, by its whole name; of `from a import b` a and a.b."""
    package = file.relative_to("src").parent.parts if file.parts[0] == "src" else ()
    for node in ast.walk(ast.parse(text, str(file))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{name.name}" for name in node.names)


def module_circles(house):
    """Modules of the package in Python that import each other in a circle."""
    modules = {}
    for file in house.texts:
        if file.suffix == ".py" and file.parts[:2] == ("src", PACKAGE):
            modules[".".join(file.relative_to("src").with_suffix("").parts).removesuffix(".__init__")] = file
    uses = {name: {*imported_names(file, house.texts[file])} & modules.keys() - {name} for name, file in modules.items()}
    yield from circles_of(uses, "modules")


def changed_paths(house):
    """Programs and modules in Python that change where modules are looked for."""
    for file, text in house.texts.items():
        if file.parts[0] not in ("scripts", "src"):
            continue
        if re.search(r"\bsys\.path\b|\bimportlib\.(util|machinery)\b", text):
            yield f"{file}: changes where modules are looked for: those of the package are in src/{PACKAGE}."
        elif re.search(r"\b__import__\b|\bimport_module\b", text):
            yield f"{file}: imports a module by its name as a text, which no rule sees: write import."


RULES = (
    module_circles,
    changed_paths,
)
