#!/usr/bin/env python3
"""Compares the .msg files of ttfusion_msgs, which ROS 2 users build, with the IDL of DDS. Messages, fields, their order and
types must be equal. The wire format has no names: a swap would go unseen.

    message_files_test.py FOLDER
"""

import pathlib
import re
import sys

PRIMITIVES = {"bool": "boolean", "byte": "octet", "uint8": "octet", "int8": "int8", "uint16": "unsigned short",
              "int16": "short", "uint32": "unsigned long", "int32": "long", "uint64": "unsigned long long",
              "int64": "long long", "float32": "float", "float64": "double", "string": "string"}


def idl_type(ros: str, package: str) -> tuple[str, str]:
    """The IDL's type and the bounds behind the field's name."""
    match = re.fullmatch(r"([\w/]+?)(\[(\d*)\])?", ros)
    base, array, length = match[1], match[2], match[3]
    if base in PRIMITIVES:
        base = PRIMITIVES[base]
    elif "/" in base:
        base = "{}::msg::dds_::{}_".format(*base.split("/"))
    else:
        base += "_"
    if array and not length:
        return f"sequence<{base}>", ""
    return base, f"[{length}]" if array else ""


def fields_of_msg(text: str, package: str) -> list[tuple[str, str]]:
    fields = []
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if not line or "=" in line:   # a constant: not on the wire
            continue
        ros, name = line.split()
        base, bounds = idl_type(ros, package)
        fields.append((base, name + bounds))
    return fields


def structs_of_idl(text: str) -> dict[str, list[tuple[str, str]]]:
    text = re.sub(r"//[^\n]*", "", text)
    structs = {}
    for name, body in re.findall(r"struct (\w+)_ \{(.*?)\}", text, re.DOTALL):
        structs[name] = [tuple(part.rsplit(" ", 1)) for part in
                         (" ".join(field.split()) for field in body.split(";")) if part]
    return structs


def main() -> int:
    folder = pathlib.Path(sys.argv[1])
    package = folder / "ttfusion_msgs"
    idl = structs_of_idl((folder / "ttfusion_messages.idl").read_text())
    files = {file.stem: fields_of_msg(file.read_text(), package.name) for file in (package / "msg").glob("*.msg")}
    wrong = []
    if not idl or idl.keys() != files.keys():
        wrong.append(f"the IDL has {sorted(idl)}, the package {sorted(files)}")
    for name in idl.keys() & files.keys():
        if idl[name] != files[name]:
            wrong.append(f"{name}: the IDL has {idl[name]}, the .msg file {files[name]}")
    build = (package / "CMakeLists.txt").read_text()
    wrong += [f"CMakeLists.txt does not build msg/{name}.msg" for name in files if f"msg/{name}.msg" not in build]
    print("\n".join(wrong) or f"ttfusion_msgs: {len(files)} messages, as in the IDL")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
