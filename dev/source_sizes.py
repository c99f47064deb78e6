"""How large rooms, sources and functions are, for dev/check_rooms: no larger than what one can know by heart.

Of functions in C++ clang-tidy measures the bodies, see readability-function-size in .clang-tidy; those outside of
classes, tests, which are macros to it, and lambdas outside of functions, which it passes over, are measured here with
their heads.
"""

import ast
import collections
import re

LARGEST_SHARE = 0.25  # of all lines of C++, in one room, or in one folder without the folders in it
LONGEST_SOURCE = 400  # [lines]
LONGEST_FUNCTION = 60  # [lines]
LONGEST_CMAKE = 200  # [lines]

# What may begin a function outside of classes, as clang-format sets it: at the margin.
CPP_HEAD = re.compile(r"(?!namespace\b|using\b|typedef\b|extern\b|struct\b|class\b|enum\b|union\b)[A-Za-z_[]")
CPP_LAMBDA = re.compile(r"(\w+)\s*=\s*\[")
CPP_NAME = re.compile(r"((?:TYPED_)?TEST(?:_[FP])?\([^)]*\)|[\w:~]+(?=\())")
SHELL_FUNCTION = re.compile(r"^(?:function )?([\w-]+) ?(?:\(\))?\s*[{(]\n(?:(?![})]).*\n)*[})]", re.MULTILINE)


def line_count(text):
    return len(text.splitlines())


def large_rooms(house):
    """Rooms, and folders that are no room, with too much of the C++."""
    lines = collections.Counter()
    for file in house.cpp:
        lines[file.parent.as_posix() if house.room_of(file) is None else house.room_of(file)] += line_count(house.texts[file])
    total = sum(lines.values())
    most = LARGEST_SHARE * total
    for folder, count in lines.items():
        if count > most:
            yield f"{folder}: holds {count} of {total} lines of C++, more than {100 * LARGEST_SHARE:.0f} %."


def long_sources(house):
    for file, text in house.texts.items():
        if line_count(text) > LONGEST_SOURCE:
            yield f"{file}: has {line_count(text)} lines, more than {LONGEST_SOURCE}."


def long_functions(house):
    """Functions in Python."""
    for file, text in house.texts.items():
        if file.suffix != ".py" and "python" not in text.partition("\n")[0]:
            continue
        for node in ast.walk(ast.parse(text, str(file))):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                length = node.end_lineno - node.lineno + 1
                if length > LONGEST_FUNCTION:
                    yield f"{file}:{node.lineno}: {node.name} has {length} lines, more than {LONGEST_FUNCTION}."


def cpp_functions(text):
    """Functions at the margin, tests and lambdas among them: name, first line from 1, number of lines with the head."""
    head, body = None, None
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        if head is None:
            head = number if CPP_HEAD.match(line) else None
        if head is None:
            continue
        if body is not None and line.startswith("}"):
            text_of_head = " ".join(lines[head - 1 : body])
            name = (CPP_NAME if line == "}" else CPP_LAMBDA).search(text_of_head)
            if name is not None:
                yield name.group(1), head, number - head + 1
            head, body = None, None
        elif body is None and line.endswith("{"):
            body = number
        elif body is None and line.endswith((";", "}")):
            head = None


def long_cpp_functions(house):
    for file in house.cpp:
        for name, begin, length in cpp_functions(house.texts[file]):
            if length > LONGEST_FUNCTION:
                yield f"{file}:{begin}: {name} has {length} lines, more than {LONGEST_FUNCTION}."


def long_shell_functions(house):
    for file, text in house.texts.items():
        if file.suffix != ".sh" and not re.match(r"#!.*\b(ba|da)?sh\b", text):
            continue
        for function in SHELL_FUNCTION.finditer(text):
            length = line_count(function.group(0))
            if length > LONGEST_FUNCTION:
                begin = text.count("\n", 0, function.start()) + 1
                yield f"{file}:{begin}: {function.group(1)} has {length} lines, more than {LONGEST_FUNCTION}."


def long_cmake_files(house):
    folders = [house.root, *(house.root / folder for folder in (*house.folders, "cmake"))]
    found = {file for folder in folders for file in folder.glob("**/*" if folder != house.root else "*")}
    for file in sorted(found):
        if file.name == "CMakeLists.txt" or file.suffix == ".cmake":
            count = line_count(file.read_text(encoding="utf-8"))
            if count > LONGEST_CMAKE:
                yield f"{file.relative_to(house.root)}: has {count} lines, more than {LONGEST_CMAKE}."


RULES = (
    large_rooms,
    long_sources,
    long_functions,
    long_cpp_functions,
    long_shell_functions,
    long_cmake_files,
)
