# SPDX-License-Identifier: Apache-2.0
"""make_stubs.py OUT.pyi: writes the stubs of phalanx._core.

stubgen (mypy) makes them from the module. What pybind11 states too broadly is replaced by the table below.
PYTHONPATH must name the folder of the built package.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

HEAD = """# SPDX-License-Identifier: Apache-2.0
# Made by python/make_stubs.py.
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, "os.PathLike[str]"]
_Columns = Optional[Union[List[str], Tuple[str, ...]]]
_Floats = NDArray[np.float64]
_Mesh = Tuple[NDArray[np.float64], NDArray[np.int32]]

__version__: str
"""

# Arguments and result of functions; {} stands for "self, ".
SIGNATURES = {
    "ClosedLoop.run": "({}seed: int = ..., stiffness_n_per_m: Optional[float] = ..., press_n: Optional[float] = ..., "
                      "columns: Union[_Columns, bool] = ...) -> Trial",
    "ClosedLoop.run_seeds": "({}seeds: Sequence[int], stiffness_n_per_m: Optional[float] = ..., "
                            "press_n: Optional[float] = ..., columns: Union[_Columns, bool] = ...) -> List[Trial]",
    "Motion.__init__": "({}time_s: ArrayLike, angle_rad: ArrayLike) -> None",
    "Motion.at": "({}time_s: float) -> _Floats",
    "Recording.__init__": "({}file: _Path, keys: _Path = ..., passphrase: str = ...) -> None",
    "Recording.replay": "({}progress: Optional[Callable[[float], object]] = ...) -> Dict[str, Any]",
    "Recording.table": "({}name: str) -> Dict[str, Any]",
    "Recording.tables": "({}names: Sequence[str] = ..., columns: Sequence[str] = ..., from_s: Optional[float] = ..., "
                        "to_s: Optional[float] = ..., progress: Optional[Callable[[float], object]] = ...) "
                        "-> Dict[str, Dict[str, Any]]",
    "Run.as_dict": "({}) -> Dict[str, NDArray[Any]]",
    "Scene.__init__": "({}scene: _Path = ..., set: Dict[str, Any] = ...) -> None",
    "Scene.from_arrays": "(vertices: ArrayLike, triangles: ArrayLike, friction: Optional[float] = ..., "
                         "set: Dict[str, Any] = ...) -> Scene",
    "Scene.from_text": "(text: str, folder: _Path = ..., set: Dict[str, Any] = ...) -> Scene",
    "Scene.mesh": "({}) -> _Mesh",
    "Scene.set": "({}values: Dict[str, Any]) -> None",
    "Scene.stated": "({}) -> Dict[str, Any]",
    "Scene.with_arrays": "({}vertices: ArrayLike, triangles: ArrayLike, friction: Optional[float] = ...) -> Scene",
    "Scene.__deepcopy__": "({}memo: Dict[Any, Any]) -> Scene",
    "Scene.__getitem__": "({}key: str) -> Any",
    "Scene.__setitem__": "({}key: str, value: Any) -> None",
    "Stepper.object_mesh": "({}) -> _Mesh",
    "Stepper.poses": "({}angle_rad: ArrayLike) -> Tuple[_Floats, _Floats]",
    "Stepper.segment_mesh": "({}segment: int) -> _Mesh",
    "Stepper.step": "({}angle_rad: ArrayLike, time_s: Optional[float] = ..., allow_nonfinite: bool = ...) -> Snapshot",
    "Stepper.steps": "({}angle_rad: ArrayLike, time_s: Optional[ArrayLike] = ..., columns: _Columns = ...) -> Run",
    "Study.__init__": "({}file: _Path) -> None",
    "Study.from_text": "(text: str, folder: _Path = ...) -> Study",
    "Study.run": "({}out: Optional[_Path] = ..., jobs: int = ..., restart: bool = ..., "
                 "progress: Optional[Callable[[int, int], object]] = ...) -> Dict[str, Any]",
    "made": "() -> Dict[str, str]",
    "scene_keys": "() -> Dict[str, SceneKey]",
    "scenes": "() -> List[Tuple[str, str]]",
    "simulate": "(scene: Scene, motion: Optional[Motion] = ..., seconds: Optional[float] = ..., "
                "columns: _Columns = ..., progress: Optional[Callable[[int, int], object]] = ...) -> Run",
}
STATIC = {"Scene.from_arrays", "Scene.from_text", "Study.from_text"}
# Results of attributes.
ATTRIBUTES = {"ClosedLoop.bump_s": "Tuple[float, float]", "ClosedLoop.window_s": "Tuple[float, float]",
              "SceneKey.default": "Any", "Trial.run": "Optional[Run]"}
CONSTANTS = {name: "Tuple[str, ...]" for name in ("DIGITS", "JOINTS", "SEGMENTS", "STATUS_BITS")}
KINDS = {"contact": "np.bool_", "slips": "np.bool_", "oscillating": "np.bool_", "status": "np.uint32",
         "tick": "np.uint64"}
SINGLE = {"tick": "int", "status": "int", "time_s": "float", "stiffness_factor": "float"}


def result_of(owner, name, stated):
    """Returns the type of an attribute."""
    if f"{owner}.{name}" in ATTRIBUTES:
        return ATTRIBUTES[f"{owner}.{name}"]
    if owner == "Snapshot" and name in SINGLE:
        return SINGLE[name]
    if stated == "object":  # a column
        return f"NDArray[{KINDS[name]}]" if name in KINDS else "_Floats"
    return "_Floats" if stated == "numpy.ndarray" else stated


def refined(text):
    """Returns stubgen's text with the types of the tables."""
    out, owner = [HEAD], ""
    used = set()
    attribute = False
    for line in text.splitlines():
        if re.match(r"(from|import) ", line) or "__reduce" in line:
            continue
        if match := re.match(r"class (\w+)", line):
            owner = match[1]
            out.append(line.replace("phalanx.", ""))
            continue
        if line and not line.startswith(" "):
            owner = ""
        if match := re.match(r"(\w+): ", line):
            out.append(f"{match[1]}: {CONSTANTS.get(match[1], line.split(': ', 1)[1])}")
            continue
        if line.strip() == "@property":
            attribute = True
            out.append(line)
            continue
        if match := re.match(r"( *)def (\w+)\((.*)\) -> (.*): \.\.\.$", line):
            indent, name, _, result = match.groups()
            full = f"{owner}.{name}" if owner else name
            if attribute:
                out.append(f"{indent}def {name}(self) -> {result_of(owner, name, result)}: ...")
            elif full in SIGNATURES:
                used.add(full)
                if full in STATIC:
                    out.append(f"{indent}@staticmethod")
                out.append(f"{indent}def {name}{SIGNATURES[full].format('self, ').replace('(self, )', '(self)')}: ...")
            else:
                out.append(line.replace("*args, **kwargs", "*args: Any, **kwargs: Any"))
            attribute = False
            continue
        out.append(line)
    if unknown := set(SIGNATURES) - used:
        sys.exit(f"make_stubs.py: the module has no {sorted(unknown)}; remove them from the table")
    return "\n".join(out).rstrip() + "\n"


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["stubgen", "-m", "phalanx._core", "-o", folder], check=True, stdout=subprocess.DEVNULL)
        text = (pathlib.Path(folder) / "phalanx" / "_core.pyi").read_text()
    pathlib.Path(sys.argv[1]).write_text(refined(text))


if __name__ == "__main__":
    main()
