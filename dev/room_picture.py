"""The picture of rooms and libraries in doc/architecture.md, drawn from the CMake files and the includes."""

import re

PACKAGE = "spherical_actuator_calibration"

BEGIN = "<!-- drawn by dev/draw_rooms -->\n```text\n"
END = "```\n<!-- end of the drawing -->\n"

LIBRARY = re.compile(r"^\s*add_library_of_rooms\((\w+)([^)]*)\)", re.MULTILINE)
FOLDER = re.compile(r"^\s*add_subdirectory\(([\w/]+)\)", re.MULTILINE)
ROOM = re.compile(r"^add_room\(([\w/]+)\s+LIBRARY\s+(\w+)", re.MULTILINE)
NODE = re.compile(r"^\s*add_node\((\w+)\s+([^)]*)\)", re.MULTILINE)
TOOL = re.compile(r"^\s*add_tool\((\w+)\s+(?:SOURCES([^)]*?))?LIBRARIES([^)]*)\)", re.MULTILINE)
SHARED = re.compile(r"^\s*add_library\((\w+) STATIC([^)]*)\)", re.MULTILINE)
INCLUDE = re.compile(rf'^\s*#\s*include\s*["<]{PACKAGE}/([\w/]+)/\w+\.hpp[">]', re.MULTILINE)


class Library:
    """A library of rooms, as its CMake files describe it."""

    def __init__(self, name, options):
        words, _, used = options.partition("USES")
        self.name = name
        self.exported = "EXPORTED" in words.split()
        self.uses = [word for word in used.split() if word.startswith("sac_")]
        self.rooms = []


def libraries(root):
    """All libraries in the order of their definition, with their rooms in the order of theirs."""
    texts = [(root / "src" / "CMakeLists.txt").read_text(encoding="utf-8")]
    texts += [
        path.read_text(encoding="utf-8")
        for folder in FOLDER.findall(texts[0])
        if (path := root / "src" / folder / "CMakeLists.txt").exists()
    ]
    found = {name: Library(name, options) for text in texts for name, options in LIBRARY.findall(text)}
    for text in texts:
        for room, library in ROOM.findall(text):
            found[library].rooms.append(room)
    return list(found.values())


class Program:
    """Sources in src/nodes or src/tools, as folder/name without ending, and the libraries of rooms that they link."""

    def __init__(self, name, folder, sources, used):
        self.name = name
        self.folder = folder
        self.units = [f"{folder}/{source.removesuffix('.cpp')}" for source in sources.split()]
        self.uses = [word for word in used.split() if word.startswith("sac_")]


def programs(root):
    """All programs, and what the tools share."""
    texts = {}
    for folder in ("nodes", "tools"):
        path = root / "src" / folder / "CMakeLists.txt"
        texts[folder] = path.read_text(encoding="utf-8") if path.exists() else ""
    found = [Program(name, "nodes", f"{name}_main", used) for name, used in NODE.findall(texts["nodes"])]
    for name, sources, used in TOOL.findall(texts["tools"]):
        found.append(Program(name, "tools", f"{name}_main {sources}", used))
    for name, sources in SHARED.findall(texts["tools"]):
        used = re.search(rf"^target_link_libraries\({name} PUBLIC([^)]*)\)", texts["tools"], re.MULTILINE)
        found.append(Program(name, "tools", sources, used.group(1) if used else ""))
    return found


def included_rooms(root, room, rooms):
    """Rooms whose headers a room includes, itself apart."""
    files = [
        file
        for top in (root / "include" / PACKAGE, root / "src")
        for file in sorted((top / room).rglob("*.[ch]pp"))
    ]
    found = {name for file in files for name in INCLUDE.findall(file.read_text(encoding="utf-8"))}
    return (found & set(rooms)) - {room}


def direct_uses(uses):
    """Without what comes along with another one: a → b → c needs no a → c."""

    def reached(name):
        return uses[name].union(*(reached(used) for used in uses[name]))

    return {
        name: [used for used in uses if used in all_used and not any(used in reached(other) for other in all_used)]
        for name, all_used in uses.items()
    }


def draw(root):
    """The picture as text."""
    house = libraries(root)
    rooms = [room for library in house for room in library.rooms]
    room_uses = direct_uses({room: included_rooms(root, room, rooms) for room in rooms})
    library_uses = direct_uses({library.name: set(library.uses) for library in house})
    lines = []
    for library in house:
        name = library.name + (" *" if library.exported else "")
        lines.append(f"{name:28}⇐ {', '.join(library_uses[library.name])}" if library.uses else name)
        for room in library.rooms:
            uses = ", ".join(room_uses[room])
            lines.append(f"    {room:24}← {uses}" if uses else f"    {room}")
    return "\n".join(lines) + "\n"


def drawn_in(text):
    """The picture in a page, or None where the page has no place for it."""
    begin, end = text.find(BEGIN), text.find(END)
    return text[begin + len(BEGIN) : end] if 0 <= begin < end else None


def with_picture(text, picture):
    """The page with another picture in its place."""
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    return text[:begin] + picture + text[end:]
