#!/usr/bin/env python3
"""Short functions and headers that explain themselves.

  1. Over all functions of the program: median, 90th percentile and longest, in lines from the name to the closing
     brace. A function inside another (a lambda) belongs to it.
  2. In each module the headers have half as many lines of comment as of code, at least. A comment behind code on
     its line counts as both; includes are neither.

--report prints what was counted."""
import pathlib
import re
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MEDIAN_MAX, MOST_MAX, LONGEST_MAX = 8, 25, 80
COMMENT_SHARE_MIN = 0.5

NOT_CODE = re.compile(
    r'R"(?P<mark>\w*)\(.*?\)(?P=mark)"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])*\'',
    re.S,
)
CONTAINER = re.compile(r"^(?:inline\s+|export\s+)?(?:namespace|extern)\b|\b(?:class|struct|union)\s+[\w:<>, ]*[^()]*$")
# "Foo::Foo(int a) : x_" before a brace: an initialiser of the list, the body is still to come.
IN_INIT_LIST = re.compile(r"\)\s*(?:noexcept\s*)?:(?!:).*[\w>]$", re.S)


def code_of(text):
    """The text without comments, strings and preprocessor lines; every line keeps its number."""
    lines = lambda match: re.sub(r"[^\n]", " ", match.group())
    text = NOT_CODE.sub(lines, text)
    return re.sub(r"^[ \t]*#.*(?:\\\n.*)*", lines, text, flags=re.M)


def closing(code, opening):
    """Index of the brace that closes the one at `opening`."""
    depth = 0
    for i in range(opening, len(code)):
        depth += {"{": 1, "}": -1}.get(code[i], 0)
        if depth == 0:
            return i
    return len(code) - 1


def functions(code, at=0, end=None):
    """(first character of the head, closing brace) of each function between two places outside of functions."""
    end = len(code) if end is None else end
    start = at
    while at < end:
        if code[at] in ";}" or code.startswith("public:", at) or code.startswith("private:", at):
            start = at + (1 if code[at] in ";}" else code[at:].index(":") + 1)
            at = start
            continue
        if code[at] != "{":
            at += 1
            continue
        head, close = code[start:at].strip(), closing(code, at)
        if IN_INIT_LIST.search(head):
            at = close + 1
            continue
        if CONTAINER.search(re.sub(r"template\s*<[^{}]*?>\s*(?=class|struct|union)", "", head)):
            yield from functions(code, at + 1, close)
        elif re.search(r"\)[^=]*$", head) and "=" not in re.sub(r"\(.*\)|operator\S*", "", head, flags=re.S):
            yield start + len(code[start:at]) - len(code[start:at].lstrip()), close
        at = start = close + 1


def lengths(path):
    code = code_of(path.read_text())
    for first, last in functions(code):
        yield code.count("\n", first, last) + 1, path.relative_to(ROOT), code.count("\n", 0, first) + 1


def comments_and_code(text):
    comments = code = 0
    for line in text.splitlines():
        bare = re.sub(r"//.*", "", line).strip()
        comments += "//" in line
        code += bool(bare) and not bare.startswith("#")
    return comments, code


def module_of(path):
    parts = path.relative_to(ROOT).parts
    return "/".join(parts[:2] if parts[0] == "engine" else parts[:1])


def files(suffixes):
    for top in ("engine", "render", "reports", "cli"):
        yield from (p for p in sorted((ROOT / top).rglob("*")) if p.suffix in suffixes)


def main():
    found = sorted(entry for path in files((".h", ".cpp")) for entry in lengths(path))
    lines = [entry[0] for entry in found]
    median, most = statistics.median(lines), lines[int(0.9 * len(lines))]
    problems = []
    if median > MEDIAN_MAX or most > MOST_MAX:
        problems.append(f"functions: median {median} lines (at most {MEDIAN_MAX}), 90 % within {most} ({MOST_MAX})")
    problems += [f"{path}:{line}: {count} lines (at most {LONGEST_MAX})"
                 for count, path, line in found if count > LONGEST_MAX]
    modules = {}
    for path in files((".h",)):
        comments, code = comments_and_code(path.read_text())
        total = modules.setdefault(module_of(path), [0, 0])
        total[0] += comments
        total[1] += code
    for module, (comments, code) in modules.items():
        if comments < COMMENT_SHARE_MIN * code:
            problems.append(f"{module}: {comments} lines of comment for {code} of code in its headers "
                            f"({comments / code:.2f}, at least {COMMENT_SHARE_MIN})")
    if "--report" in sys.argv:
        print(f"{len(lines)} functions: median {median} lines, 90 % within {most}, longest {lines[-1]} "
              f"({found[-1][1]}:{found[-1][2]})")
        for module, (comments, code) in modules.items():
            print(f"{module}: {comments / code:.2f} lines of comment per line of code in headers")
    print("\n".join(problems), end="\n" if problems else "")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
