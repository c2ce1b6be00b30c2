# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

from os import PathLike
from typing import Dict, Iterable, Iterator, List, Mapping, Optional, Set, Tuple, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__commit__: str  # of the sources, or "unknown"

class Error(RuntimeError):
    """A file, an option or a map is at fault; the message is a sentence."""

class Pose:
    """A pose in the plane [m, rad]; yaw is in (-pi, pi]."""

    def __init__(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> None: ...
    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def yaw(self) -> float: ...
    def inverse(self) -> Pose: ...
    def matrix(self) -> NDArray[np.float64]:
        """3 x 3, homogeneous."""
    def apply(self, points: ArrayLike) -> NDArray[np.float64]:
        """N x 2 points in frame b, for T_a_b, as points in frame a."""
    def __matmul__(self, other: Pose) -> Pose: ...
    def __iter__(self) -> Iterator[float]: ...

class SubmapId:
    """Compares equal to (trajectory, index), and such a tuple is taken for it."""

    def __init__(self, trajectory: int, index: int) -> None: ...
    @property
    def trajectory(self) -> int: ...
    @property
    def index(self) -> int: ...
    def __lt__(self, other: AnySubmapId) -> bool: ...
    def __hash__(self) -> int: ...
    def __iter__(self) -> Iterator[int]: ...

AnySubmapId = Union[SubmapId, Tuple[int, int]]

class Options:
    """All options, with their defaults; see load_options. str() is Lua."""

    def __init__(self) -> None: ...

def load_options(changes: Optional[Mapping[str, object]] = None,
                 basename: str = "sdf_global_constraints.lua",
                 directories: Iterable[Union[str, PathLike[str]]] = ()) -> Options:
    """Loads a configuration file, and changes options by their names."""

# --- Maps. ---

class Grid:
    """An occupancy grid in its submap. Cell (i, j) has its centre at
    resolution * (i + 0.5, j + 0.5) in the grid frame."""

    def __init__(self, probability: ArrayLike, known: ArrayLike, resolution: float,
                 T_submap_grid: Pose = ...) -> None:
        """ValueError unless probabilities of known cells are in (0, 1)."""
    @property
    def probability(self) -> NDArray[np.float32]:
        """Of an obstacle; meaningless where not known."""
    @property
    def known(self) -> NDArray[np.bool_]: ...
    @property
    def resolution(self) -> float: ...
    @property
    def T_submap_grid(self) -> Pose: ...

class Field:
    """A signed distance field [m]: positive in free space, negative inside
    obstacles. Larger than its grid by a rim."""

    @property
    def distance(self) -> NDArray[np.float32]: ...
    @property
    def observed(self) -> NDArray[np.bool_]: ...
    @property
    def resolution(self) -> float: ...
    @property
    def T_submap_grid(self) -> Pose: ...

class Constraint:
    """A measured pose of a node in a submap."""

    @property
    def submap(self) -> SubmapId: ...
    @property
    def node(self) -> Tuple[int, int]: ...
    @property
    def T_submap_node(self) -> Pose: ...
    @property
    def translation_weight(self) -> float: ...
    @property
    def rotation_weight(self) -> float: ...
    @property
    def is_inter_submap(self) -> bool: ...

class Map:
    @property
    def path(self) -> str: ...
    @property
    def trajectories(self) -> List[int]: ...
    @property
    def submaps(self) -> Dict[SubmapId, Pose]:
        """T_map_submap of each."""
    @property
    def constraints(self) -> List[Constraint]: ...
    @property
    def node_ids(self) -> NDArray[np.int32]:
        """N x 2: trajectory, index."""
    @property
    def node_poses(self) -> NDArray[np.float64]:
        """N x 3: x, y, yaw of the robot's tracking frame in the map."""
    @property
    def node_times(self) -> NDArray[np.float64]:
        """N: seconds since 1970."""
    @property
    def grid_ids(self) -> List[SubmapId]: ...
    def grid(self, id: AnySubmapId) -> Grid:
        """KeyError if the submap has none."""

def read_map(path: str, repair: bool = False) -> Map:
    """Reads a .pbstream with all its grids. Raises Error where it is damaged;
    `repair` leaves out submaps and nodes that have no data."""

def distance_field(grid: Grid, options: Options = ...) -> Optional[Field]:
    """None if the grid has no obstacle, or nothing is known."""

# --- Places: what is remembered of a submap. ---

class Place:
    """Arrays have one row for each feature, in the submap frame."""

    @property
    def id(self) -> SubmapId: ...
    @property
    def positions(self) -> NDArray[np.float64]:
        """N x 2 [m]."""
    @property
    def kinds(self) -> List[str]:
        """"maximum" (the middle of a room), "minimum" or "saddle" (a door)."""
    @property
    def clearances(self) -> NDArray[np.float64]:
        """Signed distance to the nearest wall [m]."""
    @property
    def strengths(self) -> NDArray[np.float64]: ...
    @property
    def orientations(self) -> NDArray[np.float64]:
        """Dominant direction of the gradient [rad]."""
    @property
    def descriptors(self) -> NDArray[np.float32]:
        """N x 18 by default: a histogram, and the mean distance."""
    @property
    def observed_area(self) -> float:
        """[m^2]"""
    def __len__(self) -> int: ...

class Match:
    @property
    def reference(self) -> SubmapId: ...
    @property
    def query(self) -> SubmapId: ...
    @property
    def T_reference_query(self) -> Pose: ...
    @property
    def score(self) -> float:
        """Log-odds of being right."""
    @property
    def verdict(self) -> str:
        """"accepted", or why not: "too_little_overlap", "contradicted",
        "unlikely", "degenerate", "ambiguous"."""
    @property
    def accepted(self) -> bool: ...
    @property
    def overlap(self) -> float:
        """Area observed by both, as a fraction of the smaller one."""
    @property
    def hit_ratio(self) -> float: ...
    @property
    def contradiction_ratio(self) -> float: ...
    @property
    def margin(self) -> float:
        """Lead over the best other pose; log-odds."""
    @property
    def rivals(self) -> List[Pose]: ...
    @property
    def inliers(self) -> NDArray[np.float64]:
        """N x 4: x, y of a keypoint in the reference, and in the query [m]."""

class Candidate:
    @property
    def id(self) -> SubmapId: ...
    @property
    def score(self) -> float: ...
    @property
    def T_reference_query(self) -> List[Pose]:
        """Poses that votes propose, best first; not verified."""

class Index:
    """Proposes which places may show the same as a query."""

    def __init__(self, options: Options = ...) -> None: ...
    def add(self, place: Place) -> None:
        """ValueError if there is a place of this id."""
    def remove(self, id: AnySubmapId) -> bool:
        """Whether it was there."""
    def query(self, place: Place) -> List[Candidate]:
        """Best first, without the place of the same id."""
    @property
    def memory_bytes(self) -> int: ...
    def __contains__(self, id: AnySubmapId) -> bool: ...
    def __len__(self) -> int: ...

def describe(grid: Grid, id: AnySubmapId = ..., options: Options = ...) -> Optional[Place]:
    """None where there is no wall."""

def match(reference: Place, query: Place, options: Options = ...) -> Optional[Match]:
    """The best pose of a pair by itself, accepted or not; None if nothing
    proposes one. Look at `accepted`."""

# --- Whole maps. ---

class DescribedMap:
    """The places of a map, without its grids."""

    @property
    def ids(self) -> List[SubmapId]: ...
    def place(self, id: AnySubmapId) -> Place:
        """KeyError if the submap has none: no walls."""
    def __len__(self) -> int: ...

def describe_map(path: str, options: Options = ..., threads: int = 0,
                 repair: bool = False) -> DescribedMap: ...

def recognize(map: DescribedMap, query: Optional[DescribedMap] = None, options: Options = ...,
              threads: int = 0) -> List[Match]:
    """As the subcommand match: pairs within a map, or of a query's submaps with
    those of the map, verified with their neighbours. Accepted or not. The
    result does not depend on the number of threads; 0: all cores."""

class Closure:
    @property
    def match(self) -> Match: ...
    @property
    def status(self) -> str:
        """"in_graph", or why not."""

class ClosedMap:
    @property
    def closures(self) -> List[Closure]: ...
    @property
    def submaps(self) -> Dict[SubmapId, Pose]:
        """T_map_submap after the optimisation."""
    @property
    def torn_submaps(self) -> List[SubmapId]: ...
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def close_loops(path: str, output: Optional[str] = None, options: Options = ...,
                frozen_trajectories: Set[int] = ..., threads: int = 0,
                repair: bool = False) -> ClosedMap:
    """As the subcommand close_loops; writes the map to `output`, if given."""

# --- Against the truth. ---

class MatchScore(TypedDict):
    pairs: int
    positives: int
    answers: int
    wrong: int
    recall_at_precision_1: float
    recall_at_precision_99: float
    average_precision: float
    threshold: Optional[float]
    median_translation_error: Optional[float]  # [m]
    median_rotation_error: Optional[float]  # [rad]
    accepted_right: int
    accepted_near: int
    accepted_wrong: int
    accepted_recall: float  # right accepted matches of positive pairs over these

class PoseErrors(TypedDict):
    count: int
    mean: float  # [m]
    median: float
    percentile_90: float
    max: float
    mean_rotation: float  # [rad]
    median_rotation: float
    percentile_90_rotation: float
    max_rotation: float

def score_matches(matches: List[Match], map: Map, truth: str, query: Optional[Map] = None,
                  query_truth: Optional[str] = None) -> MatchScore:
    """`truth` is a file of lines kind,trajectory,index,x,y,yaw. Raises Error if
    it is that of another map."""

def node_errors(map: Map, truth: str) -> PoseErrors:
    """Of all nodes, after a rigid alignment."""
