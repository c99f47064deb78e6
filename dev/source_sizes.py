"""How large rooms, sources and functions are, for dev/check_rooms: no larger than what one can know by heart.

Functions are measured with their heads; clang-tidy, see readability-function-size in .clang-tidy, measures bodies alone,
and neither tests, which are macros to it, nor lambdas outside of functions.
"""

import ast
import collections
import re

LARGEST_SHARE = 0.25  # of all lines of C++, in one room, or in one folder without the folders in it
LONGEST_SOURCE = 400  # [lines]
LONGEST_FUNCTION = 60  # [lines]
LONGEST_CMAKE = 200  # [lines]

# What of C++ holds no code, or could be taken for its braces: strings, comments, lines of the preprocessor.
CPP_TEXT = re.compile(
    r"""R"([^\s()\\]{0,16})\(.*?\)\1"
    |"(?:\\.|[^"\\\n])*"
    |(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'
    |//[^\n]*
    |/\*.*?\*/
    |^[ \t]*\#(?:\\\n|[^\n])*""",
    re.MULTILINE | re.DOTALL | re.VERBOSE,
)
CPP_SIGN = re.compile(r"[(){};]")
# What stands before the brace of a function and of a lambda.
QUALIFIERS = r"(?:\s*(?:\b(?:const|noexcept|override|final|mutable|constexpr|try)\b|&&?|->[^;=()]+))*\s*"
CPP_NAME = r"(?:[\w:~]+::)?operator\s*[^\s\w]+|operator[\w\s:<>*&]+|[\w:~]+"
CPP_FUNCTION = re.compile(rf"({CPP_NAME})\s*\(.*\){QUALIFIERS}(?::[^:].*)?$", re.DOTALL)
CPP_TEST = re.compile(r"(?:TYPED_)?TEST(?:_[FP])?\([^)]*\)")
CPP_LAMBDA = re.compile(rf"(?:(\w+)\s*=\s*)?\[[^\[\]]*\]\s*(?:\([^;]*\))?{QUALIFIERS}$")
CPP_ACCESS = re.compile(r"\s*(?:(?:public|private|protected)\s*:\s*)?")
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


def without_text(code):
    """The same C++, with blanks for what is none."""
    return CPP_TEXT.sub(lambda found: re.sub(r"[^\n]", " ", found.group(0)), code)


def head_of(statement, in_parentheses):
    """What begins with the brace after this statement: name and place of its first character; None of no function."""
    first = CPP_ACCESS.match(statement).end()
    found = CPP_LAMBDA.search(statement)
    if found is not None:
        return (found.group(1), first) if found.group(1) else ("a lambda", found.start())
    found = None if in_parentheses else CPP_TEST.search(statement, first) or CPP_FUNCTION.search(statement, first)
    return (found.group(found.lastindex or 0), first) if found else None


def cpp_functions(text):
    """Functions, tests and lambdas that are in no other one: name, first line from 1, number of lines with the head."""
    code = without_text(text)
    signs = [(found.group(0), found.start()) for found in CPP_SIGN.finditer(code)]
    blocks, parentheses, begin = [], 0, 0  # open braces; open parentheses and first character of the statement
    for sign, at in signs:
        if sign in "()":
            parentheses += 1 if sign == "(" else -1
        elif sign == ";" and parentheses == 0:
            begin = at + 1
        elif sign == "{":
            is_inside = bool(blocks) and (blocks[-1][3] or blocks[-1][2] is not None)
            head = None if is_inside else head_of(code[begin:at], parentheses > 0)
            blocks.append((begin, parentheses, head, is_inside, at))
            parentheses, begin = 0, at + 1
        elif sign == "}" and blocks:
            begin, parentheses, head, _, brace = blocks.pop()
            goes_on = parentheses > 0 or re.match(r"\s*(?:[,{=.)(-]|\[(?!\[)|catch\b)", code[at + 1 : at + 200])
            if head is not None:
                first = code.count("\n", 0, begin + head[1]) + 1
                yield head[0], first, code.count("\n", 0, at) + 2 - first
            if not goes_on:
                begin = at + 1
            else:
                # As an expression it is no brace of what follows.
                code = code[:brace] + re.sub(r"[^\n]", " ", code[brace : at + 1]) + code[at + 1 :]


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


def cmake_files(house):
    """Sorted."""
    folders = [house.root, *(house.root / folder for folder in (*house.folders, "cmake"))]
    found = {file for folder in folders for file in folder.glob("**/*" if folder != house.root else "*")}
    return sorted(file for file in found if file.name == "CMakeLists.txt" or file.suffix == ".cmake")


def long_cmake_files(house):
    for file in cmake_files(house):
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
