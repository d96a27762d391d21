// The records of a plan file, exactly as they lie in the mapped bytes: little endian, fixed
// strides, no pointers. `file` -> header -> directory -> sections, each 64-byte aligned. Lengths in
// metres, angles in radians, times in seconds, quaternions (w, x, y, z). Every index points into
// the section its comment names; kNone means "absent".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace probe::plan {

inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'P', 'L', 'A', 'N', '\r', '\n', 0x1a};
inline constexpr std::uint16_t kMajor = 1;
inline constexpr std::uint16_t kMinor = 0;
inline constexpr std::uint32_t kNone = 0xffffffffu;
inline constexpr std::size_t kAlignment = 64;
constexpr std::uint64_t align_up(std::uint64_t at) {
  return (at + kAlignment - 1) / kAlignment * kAlignment;
}

// Sections ascend by kind in the file, none repeats; see sections.def.
enum class Section : std::uint32_t {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) k##name = kind,
#include "runtime/plan/sections.def"
};

inline constexpr std::uint16_t kIgnorable = 1;

struct StringRef {
  std::uint32_t offset = 0;  // into kStrings
  std::uint32_t length = 0;  // bytes
};
// [first, first + count) of the section named at the field.
struct Slice {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct Header {
  std::array<std::uint8_t, 8> magic = kMagic;
  std::uint16_t major = kMajor;
  std::uint16_t minor = kMinor;
  std::uint32_t sections = 0;
  std::uint64_t file_size = 0;
  std::uint64_t zero = 0;
  std::array<std::uint8_t, 32>
      root{};  // of version and the entries that are not ignorable, see root_hash in ids.h
};
static_assert(sizeof(Header) == 64);

struct DirectoryEntry {
  std::uint32_t kind = 0;
  std::uint16_t version = 1;
  std::uint16_t flags = 0;  // kIgnorable
  std::uint64_t offset = 0;
  std::uint64_t size = 0;  // bytes, without padding
  std::uint32_t count = 0;
  std::uint32_t stride = 0;
  std::array<std::uint8_t, 32> sha256{};
};
static_assert(sizeof(DirectoryEntry) == 64);

enum class AssetKind : std::uint32_t { kVisualMesh = 1, kCollisionMesh = 2, kUrdf = 3, kPhoto = 4 };

// A file under the asset root, found by path and accepted only with these bytes.
struct AssetRecord {
  StringRef path;
  std::uint32_t kind = 0;  // AssetKind
  std::uint32_t zero = 0;
  std::uint64_t byte_size = 0;
  std::array<std::uint8_t, 32> sha256{};
  std::uint64_t zero2 = 0;
};
static_assert(sizeof(AssetRecord) == 64);

struct ObjectRecord {
  StringRef name;                   // the identifier: "carrot"
  StringRef text;                   // the name in instructions: "carrot"
  std::uint32_t visual = kNone;     // kAssets
  std::uint32_t collision = kNone;  // kAssets
  std::array<double, 3> box_min{};  // metres, model frame
  std::array<double, 3> box_max{};
  double density = 0;                   // kg/m3; 0 where it has a mass
  double friction = 0;                  // of the object's own material
  double scale = 0;                     // of its meshes; the box is scaled already; 0: as they are
  Slice cover;                          // kCovers: a texture on all of it, or none
  std::array<std::uint8_t, 4> paint{};  // sRGB and 1 where it is painted, else 0
  std::uint32_t zero = 0;
  Slice mass;     // kMasses: its own, or none
  Slice damping;  // kDampings: its own, or none
};
static_assert(sizeof(ObjectRecord) == 128);

// What an object weighs, its scale in it.
struct MassRecord {
  double mass = 0;                  // kg
  std::array<double, 3> centre{};   // m, model frame
  std::array<double, 6> inertia{};  // kg m2 about the centre: xx yy zz xy xz yz; all 0: the mass is
                                    // spread evenly over what is felt, and there is no centre
};
static_assert(sizeof(MassRecord) == 80);

// What resists an object everywhere, at its centre of mass.
struct DampingRecord {
  double shift = 0;  // N s/m
  double turn = 0;   // N m s/rad
};
static_assert(sizeof(DampingRecord) == 16);

enum class Control : std::uint32_t {
  kEeDeltaPose = 1,
  kOscPose = 2,
  kJointDelta = 3,
  kJointPosition = 4,
  kEeDeltaInterpolated = 5
};

struct FingerRecord {
  StringRef link;
  std::array<double, 3> opens{};  // unit axis in the link frame along which the finger opens
};
struct RobotRecord {
  StringRef name;
  StringRef tcp;               // link
  std::uint32_t urdf = kNone;  // kAssets
  std::uint32_t control = 0;   // Control
  double control_hz = 0;
  std::array<FingerRecord, 2> fingers{};  // without a link: there is none; more in `more_fingers`
  double grip_closed = 0;                 // finger target for gripper command -1
  double grip_open = 0;                   // finger target for gripper command +1
  double finger_friction = 0;
  double finger_patch = 0;   // torsional patch radius, m
  double link_friction = 0;  // of all other links
  double reach_min = 0, reach_max = 0;
  Slice drives;  // kDrives, one per actuated joint
  Slice meshes;  // kList of kAssets: every file the URDF names, in its order; they are part of the
                 // start
  Slice law;     // kLaws: one, of ee_delta_pose none
  Slice gears;   // kGears: one per drive, or none
  Slice more_fingers;  // kFingers: those behind the first two
};
static_assert(sizeof(RobotRecord) == 192);

inline constexpr std::uint32_t kLawUncoupled = 1;   // osc_pose: shift and turn each by its inertia
inline constexpr std::uint32_t kLawFromTarget = 2;  // joint_delta: steps go from the last target

// The numbers of a control law; what its kind does not read is 0. Of six: x y z, about x y z.
struct LawRecord {
  // osc_pose
  std::array<double, 6> kp{};       // 1/s2
  std::array<double, 6> damping{};  // 1: critical
  std::array<double, 6> output{};   // m and rad: what an action of 1 asks for
  double null_kp = 0;               // 1/s2
  double ramp = 0;                  // share of a control step
  double grip_pace = 0;             // of half the range, a physics step
  double grip_stiffness = 0;        // N/m
  double grip_limit = 0;            // N
  // joint_delta
  double most = 0;          // rad or m, a step; 0: any
  Slice home;               // kReals, osc_pose: one per joint of the arm
  std::uint32_t flags = 0;  // kLawUncoupled, kLawFromTarget
  std::uint32_t zero = 0;
  // ee_delta_interpolated: speed, acceleration, jerk of a joint's path, rad or m and s
  std::array<double, 3> arm_path{}, finger_path{};
};
static_assert(sizeof(LawRecord) == 256);

// N m and kg m2, or N and kg, by the joint's kind.
struct GearRecord {
  double friction = 0;  // what it takes to set the joint moving, and what brakes it then
  double armature = 0;  // inertia of rotor and gears, at the joint
};
static_assert(sizeof(GearRecord) == 16);

// tau = stiffness (target - q) - damping u, clamped to +-limit. SI per radian or per metre by the
// joint's kind.
struct DriveRecord {
  StringRef joint;
  double stiffness = 0, damping = 0, limit = 0;
};
static_assert(sizeof(DriveRecord) == 32);

enum class CameraAim : std::uint32_t { kLook = 1, kQuat = 2 };

struct CameraRecord {
  StringRef name;
  StringRef mount_link;
  std::uint32_t aim = 0;  // CameraAim
  std::uint32_t width = 0, height = 0;
  std::uint32_t samples = 0;         // a pixel: 4 or 16; 0 is one
  std::array<double, 3> position{};  // in the mount link's frame
  std::array<double, 4>
      aim_values{};  // look: direction xyz and 0; quat: w x y z, columns forward left up
  double fx = 0, fy = 0, cx = 0, cy = 0;  // pixels, at width x height
  Slice sensor;                           // kSensors: one, or none: a picture as it is
};
static_assert(sizeof(CameraRecord) == 128);

// What a camera does to its picture before a policy gets it; 0 everywhere: nothing.
struct SensorRecord {
  double noise = 0;     // standard deviation, of the full range of a channel
  double blur = 0;      // pixels, standard deviation
  double exposure = 0;  // factor of the light; 0: 1
  std::array<double, 4>
      patch{};  // left, top, right, bottom in shares of the picture: black; none: 0
  double dropped =
      0;  // share of the pictures that do not arrive: the one before stays; 1: the first
  std::uint32_t mirrored = 0;  // 0 or 1: left is right
  std::uint32_t zero = 0;
  bool operator==(const SensorRecord&) const = default;
};
static_assert(sizeof(SensorRecord) == 72);

inline constexpr std::uint32_t kMaxOcclusion = 16;

struct LightRecord {
  StringRef name;
  double ambient = 0;
  Slice suns;                     // kSuns
  std::uint32_t occlusion = 0;    // rays a sample that find how open it is to ambient light
  std::uint32_t shading = 0;      // 0: pixels, by suns; 1: corners of triangles, by lamps
  std::array<double, 3> color{};  // factors of all its light, r g b; zeros: white
  Slice lamps;                    // kLamps
};
static_assert(sizeof(LightRecord) == 64);

struct SunRecord {
  std::array<double, 3> direction{};  // the way light travels; not normalised
  double power = 0;
  std::uint32_t shadow = 0;  // 0 or 1
  std::uint32_t zero = 0;
};
static_assert(sizeof(SunRecord) == 40);

enum class LampKind : std::uint32_t { kSpot = 1, kSun = 2, kHeadlight = 3 };

// What lights corners of triangles; 0 what a kind does not have.
struct LampRecord {
  std::uint32_t kind = 0;  // LampKind
  std::uint32_t zero = 0;
  std::array<double, 3> position{};   // m, world; of a spot
  std::array<double, 3> direction{};  // the way light travels, not normalised; of a spot and a sun
  double power = 0, specular = 0, ambient = 0;
  double cutoff = 0;             // rad from a spot's direction, to pi / 2; 0: none
  double exponent = 0;           // how a spot narrows
  std::array<double, 3> fade{};  // its light is divided by a + b d + c d^2; zeros: by 1
  bool operator==(const LampRecord&) const = default;
};
static_assert(sizeof(LampRecord) == 120);

struct SceneRecord {
  StringRef name;
  std::uint32_t robot = kNone;  // kRobots
  std::uint32_t photo = kNone;  // kAssets; shown wherever no link or movable object is nearest
  std::uint32_t backdrop =
      kNone;  // kAssets: static visual mesh in world coordinates, without collision
  std::uint32_t fixture_visual = kNone;     // kAssets
  std::uint32_t fixture_collision = kNone;  // kAssets; a static body
  std::uint32_t backdrop_stands = 0;        // 1: as its mesh has it where the surface is at
                                            // `backdrop_z`; 0: its table lies at the surface
  std::array<double, 3> fixture_position{};
  std::array<double, 3> base_position{};
  std::array<double, 4> base_rotation{};
  Slice joints;  // kReals: initial position of every actuated joint, in the order of kDrives
  double surface_z = 0;
  std::array<double, 4> area{};  // x min, y min, x max, y max of the surface
  double physics_hz = 0;
  double friction = 0;       // of the surface's own material
  Slice fixtures;            // kList of kFixtures, with joints; each once
  double air_density = 0;    // kg/m3: felt by robots whose law gives efforts
  double air_viscosity = 0;  // Pa s
  Slice covers;              // kCovers: other pictures on its backdrop, ascending by `what`
  double backdrop_z = 0;     // m; 0 where the backdrop does not stand
  std::uint64_t zero2[5] = {};
};
static_assert(sizeof(SceneRecord) == 256);

// What a texture covers: of a backdrop, or all of an object.
enum class CoverOf : std::uint32_t { kSurface = 1, kWalls = 2, kFloor = 3, kObject = 4 };

struct CoverRecord {
  std::uint32_t what = 0;         // CoverOf
  std::uint32_t texture = kNone;  // kAssets, a picture
  double side = 0;                // m that one picture covers
};
static_assert(sizeof(CoverRecord) == 16);

// What moves on joints that nobody drives.
struct FixtureRecord {
  StringRef name;
  std::uint32_t urdf = kNone;  // kAssets
  std::uint32_t zero = 0;
  std::array<double, 3> position{};  // of its root link, world
  std::array<double, 4> rotation{};  // w x y z
  double friction = 0;               // of its links' material
  Slice joints;                      // kFixtureJoints: all that move, in the URDF's order
  Slice parts;                       // kParts: all links with collision, in the URDF's order
  Slice meshes;                      // kList of kAssets, as a robot's
  Slice armatures;  // kReals: kg or kg m2 by joint, or none
  Slice shown;      // kShown
  std::uint64_t zero2[1] = {};
};
static_assert(sizeof(FixtureRecord) == 128);

enum class JointMotion : std::uint32_t { kTurns = 1, kSlides = 2 };

// force = stiffness (rest - q) - damping u - friction against the motion. SI per radian or per
// metre by its motion.
struct FixtureJointRecord {
  StringRef joint;           // of the URDF
  std::uint32_t motion = 0;  // JointMotion
  std::uint32_t zero = 0;
  double lower = 0, upper = 0;  // rad or m; both 0: it turns without end
  double friction = 0, damping = 0, stiffness = 0, rest = 0;
  double start = 0;  // where episodes begin that do not say otherwise
};
static_assert(sizeof(FixtureJointRecord) == 72);

// A link of a fixture that can be touched.
struct PartRecord {
  StringRef name;               // as a body: "cabinet.top_drawer"
  StringRef link;               // of the URDF
  StringRef text;               // the name in instructions, or empty
  std::uint32_t joint = kNone;  // of its fixture's: the one that moves it
  std::uint32_t declared = 0;   // 1: the text names it
};
static_assert(sizeof(PartRecord) == 32);

enum class ShownSide : std::uint32_t { kAbove = 1, kBelow = 2 };

// A link of a fixture that nothing can touch, seen only while a joint stands at a value or beyond.
struct ShownRecord {
  StringRef link;           // of the URDF
  std::uint32_t joint = 0;  // of its fixture's
  std::uint32_t side = 1;   // ShownSide
  double at = 0;            // rad or m; there it is seen
};
static_assert(sizeof(ShownRecord) == 24);

// A box in the frame of what it belongs to.
struct RegionRecord {
  StringRef name;                       // "cabinet.inside_top"
  std::uint32_t kind = 0;               // BodyKind: an object, a scene's surface or fixture, a part
  std::uint32_t index = kNone;          // of kObjects, kScenes, kParts
  std::array<double, 3> low{}, high{};  // m
};
static_assert(sizeof(RegionRecord) == 64);

// A box that lies otherwise than along the axes of a frame, in it.
struct TurnedBox {
  std::array<double, 3> middle{}, half{};  // m; half along its own axes
  std::array<double, 4> rotation{1, 0, 0, 0};
};
// What a region is whose `low` and `high` are the box around it.
struct TurnedRecord {
  std::uint32_t region = kNone;  // kRegions, ascending
  std::uint32_t zero = 0;
  std::array<double, 3> middle{}, half{};  // as of a TurnedBox
  std::array<double, 4> rotation{1, 0, 0, 0};
  TurnedBox box() const { return {middle, half, rotation}; }
};
static_assert(sizeof(TurnedRecord) == 88);

// Metric code, see isa.def.
struct Instruction {
  std::uint8_t op = 0;
  std::uint8_t zero = 0;
  std::uint16_t dst = 0;
  std::uint16_t a = 0;
  std::uint16_t b = 0;
};
static_assert(sizeof(Instruction) == 8);

struct StateRecord {
  std::uint16_t kind = 0;  // the opcode of the one monitor that uses it
  std::uint16_t n = 0;     // HOLD: steps
};
static_assert(sizeof(StateRecord) == 4);

struct ProgramRecord {
  Slice constants;                      // kConstants
  Slice states;                         // kStates
  Slice code;                           // kCode
  Slice metrics;                        // kMetrics
  std::array<std::uint8_t, 32> hash{};  // program_hash of ids.h: what is judged
};
static_assert(sizeof(ProgramRecord) == 64);

enum class MetricType : std::uint32_t { kBool = 1, kReal = 2 };

struct MetricRecord {
  StringRef name;
  std::uint32_t type = 0;     // MetricType
  std::uint32_t readout = 0;  // Readout, for people; the code does the work
};
static_assert(sizeof(MetricRecord) == 16);

enum class Readout : std::uint32_t {
#define PROBE_READOUT(id, name, words, takes, gives, monitor, keeps, never) k##name = id,
#include "runtime/plan/readouts.def"
};

// Task-local bodies, in this order: source and target (those that there are), the objects of other
// roles, distractors, objects that the layout placed, surface, fixture (if any), then links:
// fingers in the robot's order, then every other link with collision in URDF order; then the parts
// of the scene's fixtures with joints, in their order. See roles.h.
enum class BodyKind : std::uint32_t {
  kObject = 1,
  kSurface = 2,
  kFixture = 3,
  kLink = 4,
  kPart = 5
};

struct BodyRecord {
  std::uint32_t kind = 0;   // BodyKind
  std::uint32_t index = 0;  // kObject: kObjects; kLink: 0, 1 fingers, then on; kPart:
                            // kParts; else 0
  StringRef name;
};
static_assert(sizeof(BodyRecord) == 16);

struct PlacementRecord {
  std::uint32_t object = kNone;  // kObjects
  std::uint32_t zero = 0;
  std::array<double, 3> position{};  // model origin, world, before the drop
  std::array<double, 4> rotation{};  // w x y z
};
static_assert(sizeof(PlacementRecord) == 64);

enum class RoleKind : std::uint32_t {
  kOne = 1,     // one object
  kSet = 2,     // one or more
  kPlaced = 3,  // in no role: what the layout puts into the scene by name
  kPart = 4,    // a part of a fixture: that body of the task
  kRegion = 5,  // `first` is of kRegions
  kPartOfSet = 6,      // the same of a set: one of several records of its name, which follow one another
  kPartDistractor = 7,  // in no role: a part that may be taken for another
};

// What fills a role beside source, target and distractors: bodies [first, first + count) of a task.
// Source and target stand here, too, where a part or a region fills them.
struct RoleRecord {
  StringRef name;          // as declared; empty: kPlaced
  std::uint32_t kind = 0;  // RoleKind
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t zero = 0;
  std::uint64_t zero2 = 0;
};
static_assert(sizeof(RoleRecord) == 32);

struct TaskRecord {
  StringRef name;
  StringRef prompt;
  std::uint32_t scene = kNone;
  std::uint32_t camera = kNone;
  std::uint32_t light = kNone;
  std::uint32_t program = kNone;
  std::uint32_t source = 0;  // kObjects, or kNone
  std::uint32_t target = 0;  // kObjects, or kNone
  Slice bodies;              // kBodies; which of them has which role: roles.h
  std::uint32_t distractors = 0;
  std::uint32_t horizon = 0;       // control steps
  std::uint32_t baseline = kNone;  // kTasks
  std::uint32_t axes = 0;          // bit mask of Axis: what differs from the baseline
  std::uint32_t ood = 0;           // bit mask: 1 source, 2 target, 4 relation
  std::uint32_t idle = 0;          // control steps between settling and the first that is judged
  StringRef allow;                 // reason of an allowed confounded comparison, or empty
  Slice episodes;                  // kEpisodes
  double drop = 0;                 // m above the surface; placements contain it
  double settle = 0;               // s, per phase of the drop
  std::array<std::uint8_t, 32> judge_id{};
  Slice views;  // kViews, the first shows `camera`; empty: that camera alone, under its own name
  Slice roles;  // kRoles, in the order of their bodies
  std::uint32_t delay = 0;  // control steps until an action acts
  std::uint32_t zero = 0;
  Slice moves;  // kMoves, ascending by body; legs of one body follow one another
  std::uint64_t zero2[3] = {};
};
static_assert(sizeof(TaskRecord) == 192);

enum class Way : std::uint32_t { kBack = 0, kLoop = 1, kOnce = 2, kRound = 3 };

// A leg of the way that an object takes by itself, from the first step on and until the robot
// touches it; see moves.h.
struct MoveRecord {
  std::uint32_t body = 0;  // task-local: an object
  std::uint32_t way = 0;   // Way, alike for all legs of a body
  std::array<double, 2>
      to{};          // m, from where it lies when the episode begins; of kRound the centre
  double speed = 0;  // m/s, alike for all legs of a body
};
static_assert(sizeof(MoveRecord) == 32);

// A camera as a policy knows it: the name stays when a variant puts another camera in its place.
struct ViewRecord {
  StringRef name;
  std::uint32_t camera = kNone;  // kCameras
  std::uint32_t photo = kNone;   // kAssets; behind this camera's picture
};
static_assert(sizeof(ViewRecord) == 16);

inline constexpr std::uint32_t kMaxViews = 16;

// What an instruction says of places: its words denote one body alone. Proved of every start where
// things are put down, and judged once more where they have come to rest. See claims.h.
struct ClaimRecord {
  std::uint32_t task = kNone;     // kTasks
  std::uint32_t body = kNone;     // task-local: the object that the words mean
  std::uint32_t program = kNone;  // kPrograms: a truth for every body that they may denote
  std::uint32_t zero = 0;
  StringRef text;  // the words
  std::uint64_t zero2 = 0;
};
static_assert(sizeof(ClaimRecord) == 32);

// What a policy is told in place of the task's instruction, or of the sentence before this one, from the
// observation behind the first control step after which a condition holds. See later.h.
struct LaterRecord {
  std::uint32_t task = kNone;     // kTasks
  std::uint32_t program = kNone;  // kPrograms: the condition, its one truth, judged from the first step on
  StringRef text;                 // the sentence
  std::uint64_t zero[2] = {};
};
static_assert(sizeof(LaterRecord) == 32);

enum class Skill : std::uint32_t {
#define PROBE_SKILL(number, name, word, takes) k##name = number,
#include "runtime/plan/skills.def"
};
enum class SkillRelation : std::uint32_t {
  kNothing = 0,
  kOn = 1,
  kIn = 2,
  kBeside = 3,
  kTo = 4,
  kBy = 5
};

// A step of a task's reference solution; see skills.h. In no id.
struct SkillRecord {
  std::uint32_t task = kNone;    // kTasks
  std::uint32_t skill = 0;       // Skill
  std::uint32_t body = kNone;    // task-local: the object or part that it is done with
  std::uint32_t relation = 0;    // SkillRelation: of `put` and `turn`
  std::uint32_t to = kNone;      // task-local, of `put`: what it goes to; kNone for a region
  std::uint32_t region = kNone;  // kRegions, of `put`
  double amount = 0;             // rad, of `turn`: from where it is closed, or from where it is
};
static_assert(sizeof(SkillRecord) == 32);

enum class Axis : std::uint32_t {
#define PROBE_AXIS(bit, name, text, in, is_phrase) k##name = 1u << bit,
#include "runtime/plan/axes.def"
};

struct EpisodeRecord {
  std::uint32_t task = 0;   // kTasks
  std::uint32_t index = 0;  // 0 .. n-1 within the task
  Slice placements;         // kPlacements, of the task's objects in the order of its bodies
  std::array<std::uint8_t, 32> start_id{};
  std::array<std::uint8_t, 32> episode_id{};
  Slice joints;  // kReals: where the joints of the scene's fixtures begin, in their order; empty:
                 // where the fixtures say
  Slice arm;  // kReals: where the robot's joints begin, in drive order; empty: where the scene says
  Slice shaken;  // kReals, 7 a view of its task: how its cameras stand elsewhere, shakes.h; empty:
                 // as they say
  std::uint64_t zero[3] = {};
};
static_assert(sizeof(EpisodeRecord) == 128);

struct SetRecord {
  StringRef name;
  Slice members;  // kList of kTasks
};
static_assert(sizeof(SetRecord) == 16);

struct SuiteRecord {
  StringRef name;
  StringRef prefix;
  StringRef trained_on;
  Slice members;   // kList of kTasks
  Slice seeds;     // kList
  Slice episodes;  // kList of kEpisodes: those it runs of its members; none: all
  std::uint64_t zero[2] = {};
};
static_assert(sizeof(SuiteRecord) == 64);

// ---- what a model is asked; see questions.def

enum class QuestionForm : std::uint32_t {
#define PROBE_QUESTION_FORM(id, name, word) k##name = id,
#include "runtime/plan/questions.def"
};
enum class QuestionTruth : std::uint32_t {
#define PROBE_QUESTION_TRUTH(id, name, takes, says) k##name = id,
#include "runtime/plan/questions.def"
};
enum class QuestionMoment : std::uint32_t {
#define PROBE_QUESTION_MOMENT(id, name, words) k##name = id,
#include "runtime/plan/questions.def"
};
enum class OmissionReason : std::uint32_t {
#define PROBE_QUESTION_OMISSION(id, name, says) k##name = id,
#include "runtime/plan/questions.def"
};

// One statement of a `questions` declaration: a kind of question, asked of many tasks.
struct FamilyRecord {
  StringRef set;             // the name of the declaration
  StringRef name;            // of the statement
  StringRef text;            // as written, with its placeholders
  std::uint32_t form = 0;    // QuestionForm
  std::uint32_t moment = 0;  // QuestionMoment
  std::uint32_t pixels = 0;  // what must be seen shows at least so many, or it is not asked
  std::uint32_t zero = 0;
  std::uint64_t zero2[3] = {};
};
static_assert(sizeof(FamilyRecord) == 64);

// What is asked of every start of a task.
struct QuestionRecord {
  std::uint32_t family = kNone;  // kFamilies
  std::uint32_t task = kNone;    // kTasks
  StringRef text;                // in full
  Slice options;                 // kOptions, in the order of the first rotation; of other forms
                                 // than a choice the objects that it or an answer can speak of
  std::uint32_t truth = 0;       // QuestionTruth
  // When the truth is proved: of a choice the option, of a yes or no 1 or 0, of a number itself.
  // kNone otherwise.
  std::uint32_t right = kNone;
  // Which of its options a truth is about, or kNone. Mentions: what is moved, and where to.
  std::uint32_t a = kNone, b = kNone;
  // kPrograms: its one truth, at the end of the recorded episode, is the right answer; else kNone.
  std::uint32_t program = kNone;
  std::uint32_t zero = 0;
  std::array<std::uint8_t, 32> question_id{};  // question_id of ids.h: what is asked and is right
  std::uint64_t zero2[2] = {};
};
static_assert(sizeof(QuestionRecord) == 96);

inline constexpr std::uint32_t kMustBeSeen = 1;  // of OptionRecord::flags

struct OptionRecord {
  StringRef text;              // the plain name, as shown
  std::uint32_t body = kNone;  // task-local, an object; none: something that is not in the scene
  std::uint32_t flags = 0;     // kMustBeSeen: else the question is not asked of this picture
  Slice words;                 // kWords: what denotes it alone among the options
  std::uint64_t zero = 0;
};
static_assert(sizeof(OptionRecord) == 32);

struct OmissionRecord {
  std::uint32_t family = kNone;  // kFamilies
  std::uint32_t task = kNone;    // kTasks
  std::uint32_t reason = 0;      // OmissionReason
  std::uint32_t zero = 0;
};
static_assert(sizeof(OmissionRecord) == 16);

// What a span tells the place of: an element of the section of that name.
enum class SpanKind : std::uint32_t {
  kCode = 1,
  kTasks = 2,
  kObjects = 3,
  kMetrics = 4,
  kFamilies = 5
};

// Where an instruction or a record came from, ascending by (what, index). A truth that several
// metrics share may have one for each metric that depends on it, in their order.
struct SpanRecord {
  std::uint32_t what = 0;  // SpanKind
  std::uint32_t index = 0;
  std::uint32_t text = 0;            // kTexts
  std::uint32_t begin = 0, end = 0;  // bytes
};
static_assert(sizeof(SpanRecord) == 20);

struct TextRecord {
  StringRef path;  // into kTextBytes, unlike all others: stripping sources must not change kStrings
  Slice bytes;     // kTextBytes
};
static_assert(sizeof(TextRecord) == 16);

}  // namespace probe::plan
