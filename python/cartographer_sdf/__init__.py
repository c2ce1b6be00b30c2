# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

"""Maps of Cartographer 2D, their signed distance fields, and place recognition.

Frames and units are those of the project: metres and radians; T_a_b takes
coordinates in frame b to coordinates in frame a. Arrays of grids and fields
are indexed [i, j]: x grows with i, y with j (matplotlib shows array.T with
origin="lower"). What each function takes and returns is in __init__.pyi.
"""

import pathlib
import tempfile

from ._core import (
    Audit, AuditedConstraint, Candidate, Change, ClosedMap, Closure, Constraint, DescribedMap,
    Error, Field, Grid, HostMotion, Index, Jump, Localization, Map, MapExamination, Match,
    MergedMap, MergedSession, OdometryScan, Options, PanoramaMap, Place, Placement, Pose, QueryPart,
    Scan, ScanCandidate, ScanLocalization, ScanSession, SessionAnswer, SessionLink, SubmapId, Walls,
    audit, close_loops, describe, describe_map, distance_field, examine_map, localize_scans, match,
    merge, node_errors, read_drive, read_map, read_scans, recognize, relocalize, score_matches,
    __commit__, __version__, _load_options)

__all__ = [
    "Audit", "AuditedConstraint", "Candidate", "Change", "ClosedMap", "Closure", "Constraint",
    "DescribedMap", "Error", "Field", "Grid", "HostMotion", "Index", "Jump", "Localization", "Map",
    "MapExamination", "Match", "MergedMap", "MergedSession", "OdometryScan", "Options",
    "PanoramaMap", "Place", "Placement", "Pose", "QueryPart", "Scan", "ScanCandidate",
    "ScanLocalization", "ScanSession", "SessionAnswer", "SessionLink", "SubmapId", "Walls", "audit",
    "close_loops", "describe", "describe_map", "distance_field", "examine_map", "load_options",
    "localize_scans", "match", "merge", "node_errors", "read_drive", "read_map", "read_scans",
    "recognize", "relocalize", "score_matches"]


def _lua(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"%s"' % value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return repr(value)


def load_options(changes=None, basename="sdf_global_constraints.lua", directories=()):
    """Loads a configuration file, and changes options by their names.

    load_options({"loop_closing.recognition.use_retrieval": False})

    Directories are searched before those installed with the module. Raises
    Error with a sentence if there is no such file or option, or if a value is
    out of its range.
    """
    directories = [str(directory) for directory in directories]
    if not changes:
        return _load_options(directories, basename)
    lines = ['include "%s"' % basename]
    lines += ["SDF_GLOBAL_CONSTRAINTS.%s = %s" % (name, _lua(value))
              for name, value in changes.items()]
    lines.append("return SDF_GLOBAL_CONSTRAINTS\n")
    with tempfile.TemporaryDirectory() as folder:
        name = "changed_options.lua"
        (pathlib.Path(folder) / name).write_text("\n".join(lines), encoding="utf-8")
        return _load_options([folder, *directories], name)
