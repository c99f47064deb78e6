"""Text files: what is read from outside, whole and of bounded size, what a terminal shows of it, and what is written.

The rules are those of the programs in C++ (readInputFile(), YamlMap, printable(), writeFileAtomically()).
"""

import contextlib
import os
import re
import stat
import sys
import tempfile

import yaml

LARGEST = 64 << 20  # [bytes] of a text file: the report of tens of thousands of samples, a study
LARGEST_DESCRIPTION = 8 << 20  # [bytes]: that of 400 coils with the covariance of all its parameters has 5.7 MB
LARGEST_CONFIGURATION = 1 << 20  # [bytes]: of a plan, too
LONGEST_EXCERPT = 80  # [characters]
LONGEST_ERROR = 1000  # [characters]
DEEPEST = 64  # maps and lists within each other
MOST_NODES = 1_000_000  # of a document; an alias counts as much as what it stands for
LONGEST_NUMBER = 1024  # [characters]; Python needs the square of it
LONGEST_INTEGER = 80  # [characters]; 64 bit as "0b..." have 66
MOST_DIRECTIVES = 8  # lines such as %TAG; libyaml compares each with all before it
DIRECTIVE = re.compile("(?:^|[\r\n\x85\u2028\u2029])\ufeff?%")
INTEGER = dict(yaml.SafeLoader.yaml_implicit_resolvers["1"])["tag:yaml.org,2002:int"]
TAGS = (None, "!", "tag:yaml.org,2002:str")  # others call for work of which the text tells nothing
KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISLNK, "a symbolic link"),
)
# Obeyed by terminals, or no character at all: bytes of a file name that are no UTF-8 are surrogates.
# So are marks that break lines or turn the direction of writing.
OBEYED = "\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff"
NOT_SHOWN = re.compile(f"[{OBEYED}]")
NOT_IN_A_LINE = re.compile(f"[\t\n{OBEYED}]")


class TextFileError(ValueError):
    """What is wrong with a file, in a sentence that names it."""


def printable(text):
    """Text that a terminal shows and does not obey: control characters but line feed and tab become "\\x1b", and so do
    marks that break lines or turn the direction of writing."""
    return NOT_SHOWN.sub(_escaped, str(text))


def excerpt(text, longest=LONGEST_EXCERPT):
    """What a message quotes of a text from outside: printable, in one line, and so many characters at most."""
    text = str(text)
    return NOT_IN_A_LINE.sub(_escaped, text[:longest]) + ("..." if len(text) > longest else "")


def _escaped(match):
    errors = "surrogateescape" if "\udc80" <= match[0] <= "\udcff" else "surrogatepass"
    return "".join(f"\\x{byte:02x}" for byte in match[0].encode("utf-8", errors))


def tell_error(program, sentence):
    """Says on the standard error why a program ends, in one line."""
    print(f"{program}: {excerpt(sentence, LONGEST_ERROR)}", file=sys.stderr)


def read_bytes(path, largest=LARGEST):
    """Content of a regular file: a FIFO would wait for ever, a device never end. Raises TextFileError."""
    try:
        with open(path, "rb", opener=_opened) as file:
            is_large = os.fstat(file.fileno()).st_size > largest
            content = b"" if is_large else file.read(largest + 1)
    except TextFileError:
        raise
    except (OSError, ValueError) as error:
        raise TextFileError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}.") from error
    if content is None:
        raise TextFileError(f"{path}: cannot be read: nothing comes from it.")
    if is_large or len(content) > largest:
        raise TextFileError(f"{path}: is larger than {largest} bytes, the most that is read of such a file.")
    return content


def beginning_of(path, size):
    """The first bytes of a regular file, fewer where it has no more. Raises TextFileError."""
    try:
        with open(path, "rb", buffering=0, opener=_opened) as file:
            return file.read(size) or b""
    except TextFileError:
        raise
    except (OSError, ValueError) as error:
        raise TextFileError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}.") from error


def _opened(path, flags):
    """Descriptor of a regular file."""
    # Not blocking: opening a FIFO would wait for somebody who writes.
    descriptor = os.open(path, flags | os.O_NONBLOCK | os.O_NOCTTY)
    mode = os.fstat(descriptor).st_mode
    if not stat.S_ISREG(mode):
        os.close(descriptor)
        raise TextFileError(f"{path}: is {_kind_of(mode)}, not a file.")
    return descriptor


def _kind_of(mode):
    return next((name for is_kind, name in KINDS if is_kind(mode)), "a device")


def other_kind(path, follow=True):
    """What stands at a path where a file belongs, such as "a FIFO"; None for a file and for nothing."""
    try:
        mode = os.stat(path, follow_symlinks=follow).st_mode
    except (OSError, ValueError):
        return None
    return None if stat.S_ISREG(mode) else _kind_of(mode)


def read_text(path, largest=LARGEST):
    """The same as text in UTF-8."""
    content = read_bytes(path, largest)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise TextFileError(f"{path}:{line}: a byte {content[error.start]:#04x} is no text in UTF-8.") from error


def read_yaml(path, largest=LARGEST):
    """Content of the one document of a YAML file."""
    return parsed_yaml(read_text(path, largest), path)


def parsed_yaml(text, path):
    """The same of a text; `path` names it in errors. Its size is known before anything is built of it."""
    _require_few_directives(text, path)
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        _Census(path).take(yaml.parse(text, Loader=loader))
        return yaml.load(text, Loader=loader)
    except TextFileError:
        raise
    # Of tags and numbers that are none, PyYAML raises whatever Python does.
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError, OverflowError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        place = f":{mark.line + 1}" if mark else ""
        problem = getattr(error, "problem", None) or (str(error) if isinstance(error, ValueError) else "")
        words = f": {' '.join(problem.split())[:200]}" if problem else ""
        raise TextFileError(f"{path}{place}: this is not valid YAML{words}.") from error


def _require_few_directives(text, path):
    for number, directive in enumerate(DIRECTIVE.finditer(text), 1):
        if number > MOST_DIRECTIVES:
            line = text.count("\n", 0, directive.end()) + 1
            raise TextFileError(f"{path}:{line}: more than {MOST_DIRECTIVES} lines begin with %; none is needed.")


class _Census:
    """Counts what a document would be made of."""

    def __init__(self, path):
        self._path = path
        self._nodes = 0
        self._open = []  # anchor and number of nodes before, of each map or list that has begun
        self._sizes = {}  # by anchor

    def take(self, events):
        """Raises TextFileError for what is not to be built."""
        documents = 0
        for event in events:
            if isinstance(event, (yaml.ScalarEvent, yaml.CollectionStartEvent)) and event.tag not in TAGS:
                self._fail(event, f"a tag, {excerpt(event.tag, 40)}, is not read; write the value without it.")
            if isinstance(event, yaml.ScalarEvent):
                self._take_scalar(event)
            elif isinstance(event, yaml.CollectionStartEvent):
                self._begin(event)
            elif isinstance(event, yaml.CollectionEndEvent):
                anchor, before = self._open.pop()
                self._sizes[anchor] = self._nodes - before
            elif isinstance(event, yaml.AliasEvent):
                if any(anchor == event.anchor for anchor, _ in self._open):
                    self._fail(event, "an alias stands within what it is an alias of.")
                self._count(event, self._sizes.get(event.anchor, 1))
            elif isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    self._fail(event, "a second document begins here; one file holds one.")

    def _take_scalar(self, event):
        self._count(event, 1)
        if event.implicit[0] and event.value[:1] in tuple("+-.0123456789"):
            self._take_number(event)
        if event.anchor is not None:
            self._sizes[event.anchor] = 1

    def _take_number(self, event):
        if len(event.value) > LONGEST_NUMBER:
            self._fail(event, f"a number has more than {LONGEST_NUMBER} digits.")
        # Of larger ones any number have the same hash, and a map of them takes the square of its size.
        if INTEGER.match(event.value):
            too_long = len(event.value) > LONGEST_INTEGER
            if too_long or not -(1 << 63) <= _integer(event.value) < 1 << 64:
                self._fail(event, "a whole number has more than 64 bit; write it as a text in quotes.")

    def _begin(self, event):
        self._open.append((event.anchor, self._nodes))
        if len(self._open) > DEEPEST:
            self._fail(event, f"maps and lists stand more than {DEEPEST} deep within each other.")
        self._count(event, 1)

    def _count(self, event, nodes):
        self._nodes += nodes
        if self._nodes > MOST_NODES:
            self._fail(event, f"there are more than {MOST_NODES} values, names and lists.")

    def _fail(self, event, sentence):
        raise TextFileError(f"{self._path}:{event.start_mark.line + 1}: {sentence}")


def _integer(text):
    """Of what INTEGER matches, as PyYAML reads it."""
    return yaml.constructor.SafeConstructor().construct_yaml_int(yaml.ScalarNode("", text))


def require_writable(path):
    """Raises TextFileError where write_text() would, before there is anything to write: a folder that is missing or
    takes no file, or a name that is no regular file's."""
    _require_regular(path)
    try:
        with contextlib.suppress(FileNotFoundError):
            os.lstat(path)  # tells a name that is too long
        with tempfile.TemporaryFile(dir=_folder_of(path)):
            pass
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def require_new_file(path, force):
    """The same, and where there is anything that `force` does not let it replace."""
    if os.path.lexists(path) and not force:
        raise TextFileError(f"{path}: the file exists already; choose another name or give --force.")
    require_writable(path)


def write_text(path, text):
    """Replaces a file by text in UTF-8: it has its whole content or, whatever happens, the one of before. Raises
    TextFileError."""
    _require_regular(path)
    temporary = None
    try:
        descriptor, temporary = tempfile.mkstemp(dir=_folder_of(path), prefix=_temporary_prefix(path))
        with os.fdopen(descriptor, "w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException as error:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        if isinstance(error, (OSError, ValueError)):
            raise _unwritable(path, error) from error
        raise


def _temporary_prefix(path):
    """Not of the whole name: what is added would make a long one longer than a file's may be."""
    return os.fsdecode(b"." + os.fsencode(os.path.basename(path))[:100] + b".")


def _folder_of(path):
    return os.path.dirname(os.path.abspath(path))


def _require_regular(path):
    try:
        is_regular = stat.S_ISREG(os.stat(path).st_mode)
    except (OSError, ValueError):
        return  # not there yet; whoever opens it tells the rest
    if not is_regular:
        raise TextFileError(f"{path}: this is not a regular file; choose another name.")


def _unwritable(path, error):
    return TextFileError(f"{path}: cannot be written: {getattr(error, 'strerror', None) or error}.")


def require_separate_files(read, written):
    """Raises TextFileError when a file has two roles, by whatever names. Both are lists of an option and its path, or
    None; --force lets a file be replaced, but never what the same run reads, or writes already."""
    taken = [(_identity(path), option, "reads") for option, path in read if path]
    for option, path in written:
        identity = _identity(path) if path else None
        for other, name, verb in taken:
            if identity is not None and identity == other:
                raise TextFileError(f"{option}: {path} is the file that {name} {verb}; choose another name.")
        taken.append((identity, option, "writes"))


def _identity(path):
    """The same for all names of a file, also of one that is not there yet; None where nothing can be."""
    try:
        status = os.stat(path)
        return status.st_dev, status.st_ino, ""
    except (OSError, ValueError):
        pass
    try:
        folder = os.stat(os.path.dirname(path) or ".")
        return folder.st_dev, folder.st_ino, os.path.basename(path)
    except (OSError, ValueError):
        return None
