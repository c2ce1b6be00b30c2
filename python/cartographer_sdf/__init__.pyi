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

class Walls:
    """How well the walls of submaps agree that lie over each other. None where
    no pair was compared."""

    @property
    def pairs(self) -> int:
        """That were compared."""
    @property
    def hit_ratio(self) -> Optional[float]:
        """Fraction of wall on walls of the other submap."""
    @property
    def contradiction_ratio(self) -> Optional[float]:
        """Fraction of wall in free space of the other."""
    @property
    def wall_distance(self) -> Optional[float]:
        """Root mean square distance of walls that meet [m]."""

class MapExamination:
    """How good a map is, without a truth."""

    @property
    def submaps(self) -> int: ...
    @property
    def places(self) -> int:
        """Submaps that show walls."""
    @property
    def is_closed(self) -> bool:
        """Whether the map has constraints that close loops."""
    @property
    def walls(self) -> Walls:
        """Where submaps lie over each other in the map."""
    @property
    def walls_along_trajectories(self) -> Walls:
        """Of submaps two indices apart, as local SLAM placed them: the noise of the
        map itself."""
    @property
    def broken_links(self) -> List[SubmapId]:
        """The first submap of each link of local SLAM that walls contradict."""
    @property
    def torn_submaps(self) -> List[SubmapId]: ...
    @property
    def slips(self) -> Dict[Tuple[int, int], float]:
        """Steps at which odometry turned by another angle than local SLAM: (trajectory,
        node at the end of the step) to by how much local SLAM turned further [rad]."""
    @property
    def self_similar(self) -> int:
        """Places that would be taken for themselves in another pose."""
    @property
    def mean_area(self) -> float:
        """That a place shows [m^2]."""
    @property
    def advice(self) -> List[str]:
        """Sentences, the gravest first: what is wrong, and what improves the map."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def examine_map(path: str, options: Options = ..., threads: int = 0,
                repair: bool = False) -> MapExamination:
    """As info --quality."""

class HostMotion:
    """What Cartographer would do to a map that it loads unfrozen: its weights of
    odometry differ from those that the map was optimised with."""

    @property
    def max_translation(self) -> float:
        """The largest motion of a node [m]."""
    @property
    def host_weights(self) -> Tuple[float, float]:
        """Of the odometry's translation and rotation, in `options`."""
    @property
    def map_weights(self) -> Tuple[float, float]:
        """Where trajectories have weights of their own, the smallest."""

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
    def refused(self) -> List[Match]:
        """What verification did not accept."""
    @property
    def torn_submaps(self) -> List[SubmapId]: ...
    @property
    def slips(self) -> Dict[Tuple[int, int], float]:
        """Steps at which odometry turned by another angle than local SLAM: (trajectory,
        node at the end of the step) to by how much local SLAM turned further [rad]."""
    @property
    def host_motion(self) -> Optional[HostMotion]:
        """None where Cartographer would not move the map."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def close_loops(path: str, output: Optional[str] = None, options: Options = ...,
                frozen_trajectories: Set[int] = ..., threads: int = 0,
                repair: bool = False, drop_odometry: bool = False) -> ClosedMap:
    """As the subcommand close_loops; writes the map to `output`, if given.
    `drop_odometry` reads and writes it as if it had no odometry, which
    Cartographer weighs anew when it loads a map unfrozen."""

class AuditedConstraint:
    """An inter-submap constraint of the map, and what is thought of it."""

    @property
    def index(self) -> int:
        """In Map.constraints."""
    @property
    def verdict(self) -> str:
        """"confirmed", "agrees_with_map", "unchecked"; doubtful: "contradicted", "ambiguous",
        "unlikely", "outvoted", "unsupported", "contradicted_by_map"."""
    @property
    def is_doubtful(self) -> bool: ...
    @property
    def error_before(self) -> Tuple[float, float]:
        """In the map as it was [m, rad]."""
    @property
    def error_after(self) -> Tuple[float, float]:
        """In the map without doubtful constraints [m, rad]."""

class Audit:
    @property
    def constraints(self) -> List[AuditedConstraint]:
        """All inter-submap constraints, in their order."""
    @property
    def doubtful(self) -> int:
        """How many are."""
    @property
    def dropped(self) -> List[int]:
        """Numbers of the constraints that the audited map lacks: the doubtful ones,
        or those that were to be dropped."""
    @property
    def walls_before(self) -> Walls: ...
    @property
    def walls_after(self) -> Walls: ...
    @property
    def host_motion(self) -> Optional[HostMotion]:
        """None where Cartographer would not move the map, or with a refusal."""
    @property
    def refusal(self) -> str:
        """Why the map without them must not replace this one; empty otherwise."""
    @property
    def leaves_out_odometry(self) -> bool:
        """Whether odometry contradicts what is kept, and was not optimised with."""
    @property
    def submaps(self) -> Dict[SubmapId, Pose]:
        """T_map_submap without the doubtful constraints, optimised."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def audit(path: str, output: Optional[str] = None, options: Options = ...,
          frozen_trajectories: Set[int] = ..., threads: int = 0, repair: bool = False,
          drop_odometry: bool = False, drop: Optional[List[int]] = None) -> Audit:
    """As the subcommand audit; writes the map without the doubtful constraints
    to `output`, if given and if there is no `refusal`. `drop` numbers the
    constraints to leave out in their place, as in Map.constraints; ValueError
    if the map has no such constraint."""

# --- Several maps. ---

class Placement:
    """Votes that agree on where the query lies."""

    @property
    def T_map_query(self) -> Pose: ...
    @property
    def score(self) -> float:
        """Log-odds of being right."""
    @property
    def is_rival(self) -> bool:
        """Whether it and the best one exclude each other."""
    @property
    def votes(self) -> List[int]:
        """Indices in Localization.matches."""

class QueryPart:
    """A part of a query that lies in the map at a pose of its own."""

    @property
    def placement(self) -> Placement: ...
    @property
    def first(self) -> SubmapId:
        """Its first and last place; places between them may belong to other
        parts."""
    @property
    def last(self) -> SubmapId: ...

class Jump:
    """A robot that was carried, between two parts of one trajectory."""

    @property
    def before(self) -> SubmapId:
        """The last place of the first part."""
    @property
    def after(self) -> SubmapId:
        """The first place of the second part."""
    @property
    def distance(self) -> float:
        """Of `after`, from where the first part puts it to where the second does
        [m]."""

class Change:
    """Walls of one map in the free space of the other."""

    @property
    def kind(self) -> str:
        """"appeared": the query has it; "vanished": the map has it."""
    @property
    def box(self) -> Tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max in the map frame [m]."""
    @property
    def wall_area(self) -> float:
        """Of its outline [m^2]."""

class Localization:
    """A certain pose, or a refusal."""

    @property
    def localized(self) -> bool: ...
    @property
    def verdict(self) -> str:
        """"localized", or why not: "too_little_seen", "nothing_alike", "uncertain",
        "ambiguous", "contradicted"."""
    @property
    def reason(self) -> str:
        """A sentence."""
    @property
    def T_map_query(self) -> Optional[Pose]:
        """The query's map frame in the map frame; None unless localized."""
    @property
    def probability(self) -> Optional[float]:
        """Of the best placement, with the runner-up as its alternative."""
    @property
    def runner_up_probability(self) -> Optional[float]: ...
    @property
    def score(self) -> Optional[float]:
        """Log-odds of the best placement."""
    @property
    def runner_up_score(self) -> Optional[float]:
        """Of the best one that it excludes."""
    @property
    def matches(self) -> List[Match]:
        """Those that vote; references in the map."""
    @property
    def placements(self) -> List[Placement]:
        """Best first, whether localized or not."""
    @property
    def agreeing(self) -> int:
        """Votes for the best placement."""
    @property
    def contradicting(self) -> int:
        """Votes that it excludes, and `contradictions`."""
    @property
    def contradictions(self) -> List[Match]:
        """Pairs that it makes overlap, and that contradict each other there."""
    @property
    def compared(self) -> int:
        """Pairs that it makes overlap; 0 if it was not confirmed."""
    @property
    def crossed(self) -> int:
        """Of these, pairs where a long wall crosses the other's free space."""
    @property
    def parts(self) -> List[QueryPart]:
        """If localized: one, whose pose is T_map_query, unless the query drifted or
        jumped."""
    @property
    def jumps(self) -> List[Jump]: ...
    @property
    def changes(self) -> List[Change]:
        """Since the map was made, if localized; the largest first."""
    @property
    def changed_area(self) -> Optional[float]:
        """Of the boxes together [m^2]; None unless localized."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def relocalize(map: Union[str, DescribedMap], query: str, output: Optional[str] = None,
               first_seconds: Optional[float] = None, start_seconds: float = 0.0,
               options: Options = ..., threads: int = 0, repair: bool = False,
               drop_odometry: bool = False) -> Localization:
    """As the subcommand relocalize: where the query, or that window of each of
    its trajectories [s], lies in the map. To localise many queries in one map,
    describe it once.

    Writes both as one map to `output`, if given, for which both must be paths
    and the query whole; raises Error where that is refused, for example if the
    query is not localized."""

class MergedSession:
    @property
    def path(self) -> str: ...
    @property
    def group(self) -> int:
        """Sessions of one group are connected."""
    @property
    def T_merged_session(self) -> Optional[Pose]:
        """Before the optimisation; None if it is not in the merged map."""
    @property
    def left_out(self) -> str:
        """Why it is not in the merged map; empty if it is."""

class SessionLink:
    @property
    def first(self) -> int:
        """Indices in MergedMap.sessions; first < second."""
    @property
    def second(self) -> int: ...
    @property
    def localization(self) -> Localization:
        """Of the second in the first."""

class MergedMap:
    @property
    def merged(self) -> bool:
        """Whether there is a merged map. If not, the rest holds what was found."""
    @property
    def reason(self) -> str:
        """Why there is none."""
    @property
    def sessions(self) -> List[MergedSession]:
        """In the order of the paths."""
    @property
    def links(self) -> List[SessionLink]:
        """Of the pairs of sessions that were compared."""
    @property
    def closures(self) -> List[Closure]:
        """Within and between sessions; ids are those of the merged map."""
    @property
    def submaps(self) -> Dict[SubmapId, Pose]:
        """T_merged_submap after the optimisation."""
    @property
    def overlapping_pairs(self) -> int: ...
    @property
    def contradictions(self) -> List[Match]:
        """Overlapping pairs that contradict each other."""
    @property
    def host_motion(self) -> Optional[HostMotion]:
        """None where Cartographer would not move the map, or if not merged."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def merge(paths: List[str], output: Optional[str] = None, options: Options = ...,
          frozen_trajectories: Set[int] = ..., threads: int = 0, repair: bool = False,
          drop_odometry: bool = False) -> MergedMap:
    """As the subcommand merge; writes the map to `output`, if given and if
    `merged`: a refusal is an answer."""

# --- A robot, by its scans. ---

class Scan:
    """One scan of a planar sensor of a robot."""

    def __init__(self, returns: ArrayLike, misses: ArrayLike = ...,
                 T_robot_sensor: Pose = ...) -> None:
        """`returns`: N x 2 points hit, in the sensor frame [m]; `misses`: end points
        of beams without an echo, at the range of the sensor, which say nothing of
        where the robot is."""
    @property
    def returns(self) -> NDArray[np.float32]: ...
    @property
    def misses(self) -> NDArray[np.float32]: ...
    @property
    def T_robot_sensor(self) -> Pose: ...

def read_scans(path: str) -> List[Scan]:
    """Of a JSON or CSV file, as relocalize --scan takes it."""

class PanoramaMap:
    """What localising scans needs of a map, computed once."""

    def __init__(self, map: Union[str, Grid], options: Options = ...,
                 repair: bool = False) -> None:
        """Of a .pbstream, of a map of ROS (.yaml, .pgm, .png), or of a grid, whose
        submap frame is then the map frame. Raises Error if it has no wall, or no
        free space for a robot."""

class ScanCandidate:
    @property
    def T_map_robot(self) -> Pose: ...
    @property
    def probability(self) -> float: ...
    @property
    def covariance(self) -> NDArray[np.float64]:
        """3 x 3, of x, y [m^2] and the heading [rad^2], in the map frame."""
    @property
    def beams(self) -> int:
        """That were compared; what becomes of them, as fractions:"""
    @property
    def fit(self) -> float:
        """Mean: 1 for an echo on a wall, .6 at 7 cm, 0 for all others."""
    @property
    def at_wall(self) -> float: ...
    @property
    def through_wall(self) -> float: ...
    @property
    def in_free_space(self) -> float: ...
    @property
    def in_unknown(self) -> float: ...

class ScanLocalization:
    @property
    def localized(self) -> bool: ...
    @property
    def verdict(self) -> str:
        """As of Localization."""
    @property
    def reason(self) -> str: ...
    @property
    def T_map_robot(self) -> Optional[Pose]:
        """None unless localized."""
    @property
    def candidates(self) -> List[ScanCandidate]:
        """All poses that explain the scans, the most probable first."""
    @property
    def elsewhere_probability(self) -> Optional[float]:
        """That none of them is right; None where too little was seen to search."""
    @property
    def stage_seconds(self) -> List[Tuple[str, float]]: ...

def localize_scans(map: PanoramaMap, scans: List[Scan], options: Options = ...) -> ScanLocalization:
    """Of scans from one place, as relocalize --scan."""

class OdometryScan:
    """What the sensors of a robot see at one time."""

    def __init__(self, time: float, T_odometry_robot: Pose, scans: List[Scan]) -> None:
        """`time` [s] may have any origin, `T_odometry_robot` any drift."""
    @property
    def time(self) -> float: ...
    @property
    def T_odometry_robot(self) -> Pose: ...
    @property
    def scans(self) -> List[Scan]: ...

def read_drive(path: str, repair: bool = False) -> List[OdometryScan]:
    """Of JSON with odometry, a log of CARMEN (.log, .log.gz, .clf, .clf.gz), or the
    first trajectory of a .pbstream. Raises Error if there is no odometry."""

class SessionAnswer:
    @property
    def state(self) -> str:
        """"searching", "located", or "lost": located before, and searched for
        again."""
    @property
    def T_map_robot(self) -> Optional[Pose]:
        """At the latest scan; None unless located."""
    @property
    def localization(self) -> ScanLocalization:
        """What the latest scans say, at the latest one."""
    @property
    def looks(self) -> int:
        """Scans that were compared with the map since the search began."""
    @property
    def distance_driven(self) -> float:
        """Since the search began [m]."""
    @property
    def seconds(self) -> float: ...
    @property
    def use(self) -> str:
        """What became of the scan that was added: "compared", "not_moved",
        "too_few_echoes", "time_not_later", "broken_odometry",
        "odometry_jumped", "carried_away"."""

class ScanSession:
    """Finds a robot that turns or drives: the answer comes as soon as it is
    certain, and is given up where scans contradict it."""

    def __init__(self, map: PanoramaMap, options: Options = ...) -> None: ...
    def add(self, scan: OdometryScan) -> SessionAnswer:
        """The next one. Any scan is taken; `use` says what became of it."""
    @property
    def answer(self) -> SessionAnswer:
        """After the latest scan."""

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
