#!/usr/bin/env python3
"""Include directions are architecture: a module sees only what stands above it in the data flow, and each heavy
library is seen by the .cpp files of one place only."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# module: the modules that it may include (besides itself)
ALLOWED = {
    "base": set(),
    "mesh": {"base"},
    "surface": {"base"},
    "brep": {"base", "mesh", "surface"},
    "cutter": {"base"},
    "position": {"base", "mesh", "surface", "cutter"},
    "kinematics": {"base"},
    "program": {"base", "surface", "kinematics"},
    "toolpath": {"base", "surface", "cutter", "position", "program", "kinematics"},
    "flank": {"base", "surface", "cutter", "toolpath"},
    "motion": {"base", "surface", "cutter", "position", "program", "toolpath", "kinematics"},
    "machine": {"base", "mesh", "kinematics"},
    "post": {"base", "program", "toolpath", "motion", "kinematics", "machine"},
    "stock": {"base", "mesh", "surface", "cutter"},
    "collision": {"base", "mesh", "cutter", "kinematics", "machine", "motion", "stock"},
    "measure": {"base", "mesh", "surface", "cutter", "stock", "motion"},
    "proof": {"base", "mesh", "cutter", "stock", "collision", "measure"},
}
ENGINE = set(ALLOWED) | {"sim", "avoidance", "papers"}
ALLOWED["sim"] = ENGINE - {"sim", "avoidance", "papers", "post"}
ALLOWED["avoidance"] = ENGINE - {"avoidance", "papers"}
ALLOWED["papers"] = ENGINE - {"papers"}
ALLOWED["render"] = {"base", "mesh"}
ALLOWED["reports"] = ENGINE | {"render"}
ALLOWED["cli"] = ENGINE | {"render", "reports"}

# heavy library: (pattern of its includes, the places whose .cpp files may include it)
HEAVY = {
    "OpenVDB": (r"openvdb/", ("engine/stock/",)),
    # Its headers have no folder of their own: Package_Class.hxx.
    "OpenCASCADE": (r"\w+\.hxx", ("engine/brep/",)),
    "OpenMesh": (r"OpenMesh/", ("engine/mesh/",)),
    "meshoptimizer": (r"meshoptimizer", ("engine/mesh/", "render/gltf/")),
    "Boost.Math": (r"boost/math", ("engine/base/",)),
    "Boost.Geometry": (r"boost/geometry", ("engine/proof/solid_design.cpp",)),
    "toml++": (r"toml\+\+", ("engine/base/config.cpp",)),
    # One file each for what it is good at: nearest triangles of a mesh, and light.
    "Embree": (r"embree", ("engine/mesh/mesh_distance.cpp", "render/ray/")),
    "OSMesa": (r"GL/", ("render/raster/",)),
    "libav": (r"libav|libsw", ("render/movie/",)),
    "tinygltf": (r"tiny_gltf", ("render/gltf/",)),
    "HDF5": (r"hdf5", ("engine/sim/run/",)),
    "Cairo": (r"cairo", ("render/lettering.cpp",)),
    "MPI": (r"mpi\.h", ("cli/cluster/",)),
    "libpng": (r"png\.h", ("render/image_io.cpp",)),
    "libwebp": (r"webp/", ("render/image_io.cpp",)),
    "lib3mf": (r"Model/COM/", ("engine/mesh/mesh_3mf.cpp", "engine/mesh/read_3mf.cpp")),
    "assimp": (r"assimp/", ("engine/mesh/scene_reader.cpp",)),
}

# Reports show numbers, they do not compute them: of the modules of geometry and motion they see these alone.
SEEN_BY_REPORTS = {
    "kinematics": ("machine_model.h",),
    "measure": ("flank_error.h", "measure.h", "metrics.h", "part_comparison.h"),
    "motion": ("cycles/", "judged/singularity_scan.h", "offline_baseline.h", "options.h", "result.h", "speed/look_ahead.h"),
    "toolpath": ("nc_path.h", "tool_path.h"),
}

# Headers that only the .cpp files beside them include: they may show the library.
PRIVATE_HEADERS = {"stock_grid_internal.h", "occt_shape.h", "gltf_buffer.h", "gltf_mesh.h", "gl_api.h"}


def module_of(path):
    parts = path.relative_to(ROOT).parts
    return parts[1] if parts[0] == "engine" else parts[0]


def problems():
    for top in ("engine", "render", "reports", "cli"):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            place = path.relative_to(ROOT).as_posix()
            module = module_of(path)
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = re.match(r'\s*#include\s+[<"]([^>"]+)[>"]', line)
                if not found:
                    continue
                target = found.group(1)
                first = target.split("/")[0]
                if '"' in line and first in ALLOWED and first != module and first not in ALLOWED[module]:
                    yield f"{place}:{number}: {module} must not include {target}"
                if module == "reports" and first in SEEN_BY_REPORTS and '"' in line:
                    if not target.removeprefix(first + "/").startswith(SEEN_BY_REPORTS[first]):
                        yield f"{place}:{number}: reports must not compute: {target} belongs to engine"
                for library, (pattern, homes) in HEAVY.items():
                    if re.match(pattern, target) and not (
                        any(place.startswith(home) for home in homes)
                        and (path.suffix == ".cpp" or path.name in PRIVATE_HEADERS)
                    ):
                        yield f"{place}:{number}: {library} belongs to the .cpp files of {', '.join(homes)}"


found = list(problems())
print("\n".join(found)) if found else None
sys.exit(1 if found else 0)
