"""Make a Python package of ROS 2 interfaces, with the generators of the ROS wheels and a compiler.

    python build_interfaces.py FOLDER

FOLDER is named as the package, and has folders msg and action with definitions. The package is
installed into the environment of this Python. All of it is one extension module, so that nothing
has to be found at run time. Users of ROS need none of this: they have the packages themselves.
"""

import json
import os
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy
from rosidl_adapter import convert_to_idl
from rosidl_generator_c import generate_c
from rosidl_generator_py import generate_py
from rosidl_generator_type_description import generate_type_hash
from rosidl_typesupport_c import generate_c as generate_typesupport_c
from rosidl_typesupport_fastrtps_c import generate_typesupport_fastrtps_c

PREFIX = Path(sys.prefix)
SHARE = PREFIX / "share"
FAST_RTPS, PLAIN_C = "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_c"
LIBRARIES = (f"__{FAST_RTPS}.so", f"__{PLAIN_C}.so", "__rosidl_generator_c.so",
             "__rosidl_generator_py.so")  # fmt: skip
RUNTIME = ("fastcdr", "rosidl_runtime_c", FAST_RTPS, "rosidl_typesupport_fastrtps_cpp", PLAIN_C,
           "rmw", "rcutils")  # fmt: skip


def main(folder: Path) -> None:
    """Generate and compile a package."""
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / folder.name
        out.mkdir()
        generate(folder, out)
        compile_all(folder.name, out)
        install(out)


def generate(folder: Path, out: Path) -> None:
    """Write the C and Python code of all definitions."""
    definitions = sorted(path.relative_to(folder) for path in folder.glob("*/*.*"))
    for path in definitions:
        with open(os.devnull, "w") as quiet:
            stdout, sys.stdout = sys.stdout, quiet
            try:
                convert_to_idl(folder, folder.name, path, out)
            finally:
                sys.stdout = stdout
    idl = [path.with_suffix(".idl") for path in definitions]
    dependencies = sorted(f"{path.parents[1].name}:{path}" for path in SHARE.glob("*/*/*.idl"))
    packages = [f"{path.name}:{path}" for path in SHARE.iterdir() if any(path.glob("*/*.idl"))]

    def arguments(generator: str, **more: Sequence[str]) -> str:
        path = out / f"{generator}.arguments.json"
        path.write_text(json.dumps({
            "package_name": folder.name, "output_dir": str(out),
            "template_dir": str(SHARE / generator / "resource"),
            "idl_tuples": [f"{out}:{one}" for one in idl],
            "ros_interface_dependencies": dependencies, "target_dependencies": [], **more,
        }))  # fmt: skip
        return str(path)

    include = [*packages, f"{folder.name}:{out}"]
    generate_type_hash(arguments("rosidl_generator_type_description", include_paths=include))
    hashes = [f"{one}:{out / one.with_suffix('.json')}" for one in idl]
    generate_c(arguments("rosidl_generator_c", type_description_tuples=hashes))
    generate_typesupport_fastrtps_c(arguments(FAST_RTPS, type_description_tuples=hashes))
    generate_typesupport_c(arguments(PLAIN_C, type_description_tuples=hashes), [FAST_RTPS])
    generate_py(arguments("rosidl_generator_py", type_description_tuples=hashes), [PLAIN_C])


def compile_all(name: str, out: Path) -> None:
    """Compile everything into one extension module."""
    (out / "msg").mkdir(exist_ok=True)
    for generator in ("rosidl_generator_c", FAST_RTPS):
        header = f"{generator}__visibility_control.h"
        text = (SHARE / generator / "resource" / f"{header}.in").read_text()
        text = text.replace("@PROJECT_NAME@", name).replace("@PROJECT_NAME_UPPER@", name.upper())
        (out / "msg" / header).write_text(text)
    include = [PREFIX / "include", *(PREFIX / "include").iterdir(), out.parent,
               sysconfig.get_paths()["include"], numpy.get_include()]  # fmt: skip
    sources = sorted([*out.rglob("*.c"), *out.rglob("*.cpp")])
    objects = [f"{source}.o" for source in sources]
    for source, target in zip(sources, objects, strict=True):
        compiler = ["gcc"] if source.suffix == ".c" else ["g++", "-std=c++17"]
        flags = [f"-I{path}" for path in include]
        run([*compiler, "-O1", "-fPIC", "-w", *flags, "-c", str(source), "-o", target])
    module = out / f"{name}_s__{PLAIN_C}.so"
    run(["g++", "-shared", "-o", str(module), *objects, *libraries(), f"-Wl,-rpath,{PREFIX}/lib"])


def libraries() -> Iterator[str]:
    """Yield the libraries of the packages and the runtime in this environment."""
    for path in sorted((PREFIX / "lib").glob("*.so")):
        if path.name.endswith(LIBRARIES) or path.name in {f"lib{one}.so" for one in RUNTIME}:
            yield str(path)


def run(command: Sequence[str]) -> None:
    """Run a compiler, which fails loudly."""
    subprocess.run(command, check=True)


def install(out: Path) -> None:
    """Copy what Python needs, and only when everything is there."""
    target = Path(sysconfig.get_paths()["purelib"]) / out.name
    for path in [*out.rglob("*.py"), *out.rglob("*.so")]:
        place = target / path.relative_to(out)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(path.read_bytes())
    (target / "__init__.py").touch()


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
