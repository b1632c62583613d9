#!/usr/bin/env python3
"""Several .cpp of a target are compiled as one (cmake/swarf_module.cmake), so what stands in their anonymous
namespaces meets. Two files of one target must not give one name there, not even to functions that differ in their
parameters: a call could quietly take the other file's.

--report prints what was counted."""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Files with flags of their own are compiled alone.
ALONE = {"leaf_kernel.cpp", "lane_kernel.cpp", "convex_leaf_kernel.cpp", "dexel_kernel.cpp", "embedded.cpp"}


def code_of(path):
    """The text without comments, strings and preprocessor lines."""
    text = path.read_text()
    text = re.sub(r"'\\?.'", " ", text)
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.S)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', lambda m: '""' if m[0][0] == '"' else " ", text, flags=re.S)
    return re.sub(r"^\s*#.*(?:\\\n.*)*$", "", text, flags=re.M)


def declared(statement):
    """The name that a statement of a namespace gives, or None."""
    flat = re.sub(r"\[\[.*?\]\]", " ", statement).strip()
    while re.match(r"template\s*<", flat):
        depth = 0
        for i, c in enumerate(flat):
            depth += {"<": 1, ">": -1}.get(c, 0)
            if c == ">" and depth == 0:
                flat = flat[i + 1 :].strip()
                break
        else:
            return None
    if not flat or re.match(r"(static_assert|friend|using\s+namespace|namespace|TEST\w*|INSTANTIATE\w*|TYPED_TEST\w*|TEST|TEST_F|TEST_P|INSTANTIATE|BENCHMARK)\b", flat):
        return None
    found = re.match(r"(?:struct|class|enum(?:\s+class)?|union)\s+(\w+)|using\s+(\w+)\s*=", flat)
    if found:
        return found.group(1) or found.group(2)
    if flat.startswith("using") or re.search(r"\boperator\b", flat.split("=")[0]):
        return None
    head = re.split(r"[=\[]", flat, maxsplit=1)[0]
    call = re.search(r"(\w+(?:::~?\w+)*)\s*\(", head)
    if call:
        return None if "::" in call.group(1) or call.group(1) in ("TEST", "TEST_F", "TEST_P") else call.group(1)
    names = re.findall(r"[\w:]+", head)
    return names[-1] if len(names) > 1 and "::" not in names[-1] else None


def anonymous_names(path):
    """(namespace, name) of everything that stands in an anonymous namespace of the file."""
    text = code_of(path)
    stack, start, depth, i = [], 0, 0, 0
    opening = re.compile(r"\s*(?:inline\s+)?namespace\s*([\w:]*)\s*\{")
    while i < len(text):
        found = opening.match(text, i) if text[i : i + 1] in "ni \n\t" else None
        if found and not text[start:i].strip():
            stack.append(found.group(1))
            i = start = found.end()
            continue
        c = text[i]
        if c == "{":
            end, d = i, 0
            while end < len(text):
                d += {"{": 1, "}": -1}.get(text[end], 0)
                if d == 0:
                    break
                end += 1
            statement = text[start:i]
            if "" in stack:
                name = declared(statement)
                if name:
                    yield "::".join(stack), name
            i = end + 1
            # Behind the body of a function nothing follows, behind that of a type or an initialiser a ';'.
            rest = re.match(r"[^;{}]*?;", text[i:])
            if re.match(r"\s*(struct|class|enum|union)\b", re.sub(r"^\s*template\s*<[^{]*?>\s*(?=struct|class)", "", statement)) or re.search(
                r"=\s*$", statement
            ) or (rest and not rest.group(0)[:-1].strip() and "(" not in statement):
                i += rest.end() if rest else 0
            start = i
            continue
        if c == ";":
            if "" in stack:
                name = declared(text[start:i])
                if name:
                    yield "::".join(stack), name
            start = i + 1
        elif c == "}":
            if stack:
                stack.pop()
            start = i + 1
        i += 1


def targets():
    """Folder of each target that is compiled so."""
    for parent in (ROOT / "engine", ROOT / "tests/unit"):
        yield from (one for one in sorted(parent.iterdir()) if one.is_dir())
    for one in ("render", "reports", "cli", "tests/fuzz", "tests/image", "tests/property", "tests/scenes"):
        if (ROOT / one).is_dir():
            yield ROOT / one


def main():
    failed = False
    for folder in targets():
        homes = collections.defaultdict(set)
        for path in sorted(folder.rglob("*.cpp")):
            if path.name in ALONE:
                continue
            for space, name in anonymous_names(path):
                homes[space, name].add(path.relative_to(ROOT).as_posix())
        if "--report" in sys.argv:
            print(f"{len(homes):5d} names  {folder.relative_to(ROOT)}")
        for (space, name), files in sorted(homes.items()):
            if len(files) > 1:
                failed = True
                print(f"{name}: in the anonymous namespaces of {', '.join(sorted(files))}; give each its own name")
    return failed


sys.exit(1 if main() else 0)
