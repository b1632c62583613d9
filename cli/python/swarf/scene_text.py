"""Scenes as dictionaries, written as the TOML text that the program reads."""
import json
import os
import re

BARE = re.compile(r"[A-Za-z0-9_-]+\Z")


def toml_text(scene):
    """The text of scene.toml that a dictionary means: one line for each of its keys."""
    return "".join(f"{_key(name)} = {_value(value)}\n" for name, value in scene.items())


def override_texts(overrides, prefix=""):
    """"table.key=value" for each value of a dictionary that may hold tables."""
    for name, value in overrides.items():
        if isinstance(value, dict):
            yield from override_texts(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}={_value(value)}"


def _key(name):
    return name if BARE.match(name) else _value(str(name))


def _value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        # JSON escapes what TOML escapes, but for the one control character behind the ASCII letters.
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(name)} = {_value(one)}" for name, one in value.items()) + " }"
    if hasattr(value, "tolist"):  # numbers and arrays of NumPy
        return _value(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(one) for one in value) + "]"
    raise TypeError(f"a scene holds no {type(value).__name__}: write numbers, texts, lists or dictionaries")
