// The meaning of a suite as plain tables: names resolved, quantities in SI, `like` expanded. Later
// passes read this and never the tree, except for expressions, which are in expr.h. Spans point at
// the words that gave a value.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/model/expr.h"
#include "compiler/model/ids.h"
#include "compiler/model/questions.h"
#include "compiler/model/space.h"
#include "compiler/model/units.h"
#include "compiler/source/source.h"
#include "compiler/syntax/ast.h"
#include "runtime/base/result.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/format.h"
#include "runtime/robot/laws.h"
#include "runtime/robot/urdf.h"

namespace probe::sema {

// A text with the place that gave it.
struct Spelled {
  std::string text;
  Span span;
};

// ---- catalogue
// ------------------------------------------------------------------------------------------------------

// Kleene's three values.
enum class Truth : std::uint8_t { kNo, kUnknown, kYes };

struct Dataset {
  std::string name;
  std::string title;
  struct Relation {
    ObjectId subject, object;
  };
  std::vector<Relation> relations;
};

struct Attribute {
  std::string name;
  std::vector<std::string> values;
};

// A query in postfix order, so that evaluation is a loop over a small stack.
struct QueryOp {
  enum Kind : std::uint8_t { kFact, kValue, kRelation, kNot, kAnd, kOr };
  Kind kind = kFact;
  std::uint32_t a = 0;  // fact, attribute, or relation (PredicateId)
  std::uint32_t b = 0;  // value within the attribute
  // Of a relation: its objects behind the one that is described.
  std::array<ObjectId, 2> to{ObjectId::kNone, ObjectId::kNone};
};
using Query = std::vector<QueryOp>;

struct Phrase {
  std::string name;
  plan::Axis axis = plan::Axis::kLanguageAppearance;
  Spelled text;
  bool bare = false;  // takes no article
  Query means;
  std::string means_text;  // as written, for messages

  // Says where things are: what it denotes differs from start to start.
  bool is_spatial() const;
};

// A turn about the world's axes; unit quaternion (w, x, y, z), exact at multiples of 90 degrees.
struct Turn {
  std::array<double, 4> rotation{1, 0, 0, 0};
  bool operator==(const Turn&) const = default;
};

// A box with a name, in the frame of what it belongs to.
struct Region {
  std::string name;
  Span span;
  std::array<double, 3> low{}, high{};         // m; of a turned one the box around it
  std::optional<plan::TurnedBox> turned = {};  // where it lies otherwise than along those axes
  // Along its own axes, m.
  std::array<double, 3> middle() const;
  std::array<double, 3> half() const;
};

// The colour of all of an object, sRGB.
struct Paint {
  std::array<std::uint8_t, 3> rgb{};
  Span span;  // of the colour
};

// A picture that covers something, again and again.
struct Cover {
  Spelled picture;  // under assets/textures
  double side = 0;  // m that one picture covers
  bool is_same(const Cover& other) const {
    return picture.text == other.picture.text && side == other.side;
  }
};

// What a row of the objects is that is a part or a region of a fixture: it has words and facts, may
// fill a role and is nowhere placed.
struct OfFixture {
  FixtureId fixture = FixtureId::kNone;
  std::uint32_t part = 0;               // of Fixture::parts; of a region the one that it belongs to
  std::optional<std::uint32_t> region;  // of Fixture::regions
  bool is_part() const { return !region.has_value(); }
};

// What a thing weighs where it is not spread evenly by its density.
struct Mass {
  double mass = 0;  // kg
  struct Spread {
    std::array<double, 3> centre{};   // m, model frame
    std::array<double, 6> inertia{};  // kg m2 about the centre: xx yy zz xy xz yz
    bool operator==(const Spread&) const = default;
  };
  std::optional<Spread> spread;  // none: evenly over what is felt
  bool operator==(const Mass&) const = default;
};

// What resists a thing wherever it is, in proportion to how fast it goes and turns.
struct Damping {
  double shift = 0;  // N s/m
  double turn = 0;   // N m s/rad
  bool operator==(const Damping&) const = default;
};

struct Object {
  std::string name;
  bool broken = false;  // something was reported: what follows from that is not said
  Span span;            // of its name
  Span decl_span;       // of the declaration
  Spelled mesh;
  Spelled text;  // in instructions
  bool bare = false;
  bool has_box = false, has_density = false, has_friction = false;
  std::array<double, 3> box_min{}, box_max{};  // with its scale
  double scale = 1;
  Span scale_span;
  struct Unscaled {  // as written
    std::array<double, 3> box_min{}, box_max{};
    std::vector<Region> regions;
    std::optional<Mass> mass;
  } unscaled;
  std::optional<Paint> paint;
  std::optional<Cover> texture;
  Span box_span;             // of the statement
  bool box_is_read = false;  // else something was wrong with it, and was reported
  double density = 0;        // 0 where `mass` is said
  std::optional<Mass> mass;  // with its scale
  Damping damping;           // whatever its scale
  double friction = 0;
  std::vector<std::vector<std::uint32_t>> values;  // by attribute; empty: unknown
  std::vector<Truth> facts;                        // by fact
  std::vector<DatasetId> seen_in;
  bool unseen = false;
  std::vector<Turn> rest;
  std::vector<Region> regions;
  std::vector<Phrase> phrases;
  std::optional<OfFixture> of;  // behind all that are declared as objects

  const Phrase* find_phrase(std::string_view phrase) const;
};

// ---- stage
// ----------------------------------------------------------------------------------------------------------

struct Finger {
  Spelled link;
  std::array<double, 3> opens{};
};
struct Drive {
  Spelled joint;
  bool slides = false;  // as its units say, and as its joint does
  // SI. What is not written stands in the robot's description, if anywhere (see define/robot).
  double stiffness = 0, damping = 0, limit = 0, friction = 0, armature = 0;
  Span span;
};

struct Robot {
  std::string name;
  bool broken = false;  // as of an object
  RobotId like = RobotId::kNone;
  Span span;
  Spelled urdf;
  Spelled tcp;
  std::array<double, 3> points{1, 0, 0};  // the tool, in its link's frame: at what is grasped
  Span points_span;
  std::vector<Finger> fingers;
  double control_hz = 0;
  robot::Law law;  // its numbers, but for those of drives and the range of the fingers
  double reach_min = 0, reach_max = 0;
  std::vector<Drive> drives;
  std::vector<Spelled>
      dropped_drives;  // copied ones, whose joints its own description lacks or fixes
  double grip_closed = 0, grip_open = 0;
  bool grip_turns = false;  // they are angles
  double finger_friction = 1, finger_patch = 0;
  double link_friction = 1;  // of all other links: the reference engine's default material
  std::optional<robot::RobotModel>
      model;  // absent when the URDF could not be read; already reported
};

struct Camera {
  std::string name;
  bool broken = false;  // as of an object
  Span span;
  Spelled mount_link;
  RobotId mount_robot = RobotId::kNone;
  plan::CameraAim aim = plan::CameraAim::kLook;
  std::array<double, 3> position{};
  std::array<double, 4> aim_values{};
  std::uint32_t width = 0, height = 0;
  std::uint32_t samples = 0;  // a pixel: 4 or 16, 0 for one
  double fx = 0, fy = 0, cx = 0, cy = 0;
  plan::SensorRecord sensor;  // what it does to its picture; zeros: nothing
  // Where it stands in a start is up to so far along each axis of its mount, and turned by up to so
  // much about its own ahead, left and up.
  double jitter_place = 0, jitter_turn = 0;  // m, rad
  Span jitter_span;
  std::array<double, 4> turned{1, 0, 0, 0};  // of a copy that stands as in a start: by how much
  bool jitters() const { return jitter_place > 0 || jitter_turn > 0; }
  bool operator==(const Camera& other) const;  // place and lens; neither name nor sensor
  bool has_sensor() const;
};

struct Light {
  std::string name;
  Span span;
  double ambient = 0;
  std::uint32_t occlusion = 0;    // rays a sample that find how open it is to ambient light
  std::array<double, 3> color{};  // of all its light; zeros: white
  std::vector<plan::SunRecord> suns;
  bool lights_vertices = false;
  std::vector<plan::LampRecord> lamps;  // only then
  bool operator==(const Light& other) const;
};

// A camera under the name that policies know: it stays when a variant puts another in its place.
struct View {
  std::string name;
  Span span;
  CameraId camera = CameraId::kNone;
  std::optional<Spelled> overlay;  // a photo behind its picture
  bool is_named = false;           // by `as`; else the name is that of the scene's camera
};

// What moves on joints that nobody drives: a cabinet, a door, a knob.
struct Fixture {
  // What the text says of a joint.
  struct Said {
    Spelled joint;
    Span span;
    std::optional<Quantity> friction, damping, stiffness, rest, armature, start;
    Span start_span;
    bool stay = false;
  };
  // One that moves, with what acts in it. SI per radian or per metre.
  struct Joint {
    std::string name;
    bool slides = false, is_endless = false;
    double lower = 0, upper = 0;
    double friction = 0, damping = 0, stiffness = 0, rest = 0, armature = 0, start = 0;
    // Travel counts from where it is closed.
    bool closes_at_upper() const { return !is_endless && plan::closes_at_upper(lower, upper); }
  };
  // A link that can be touched; a declared one has a name of its own.
  struct Part {
    std::string name;  // "top_drawer"; of the root link, undeclared, empty: the fixture
    Spelled link;
    Spelled text;    // in instructions
    int index = -1;  // of the model's links
    std::optional<std::uint32_t> joint;
    bool declared = false;
    Span span;
    const syntax::PartStmt* said = nullptr;  // what is said of it, in `file`
    const syntax::File* file = nullptr;
    ObjectId thing = ObjectId::kNone;  // what fills a role; of a declared part
  };
  struct OwnRegion {
    Region region;
    Spelled of;              // a part's name; empty: the fixture
    std::uint32_t part = 0;  // index of parts
    Spelled text;            // in instructions; not said: as its part
    ObjectId thing = ObjectId::kNone;
  };
  // A link that is seen only while a joint stands so.
  struct Shown {
    Spelled link, joint;
    bool from_below = false;  // at `value` and below, else at it and above
    std::optional<Quantity> value;
    Span value_span;
    std::uint32_t index = 0;  // of joints
    double at = 0;            // m or rad
  };
  std::string name;
  bool broken = false;  // as of an object
  FixtureId like = FixtureId::kNone;
  Span span;
  Spelled urdf;
  bool has_place = false;
  std::array<double, 3> position{};
  Turn turn;
  double friction = 1;
  std::vector<Said> said;
  std::vector<Part> named;  // as declared
  std::vector<OwnRegion> regions;
  std::vector<Shown> shown;
  std::optional<robot::RobotModel> model;
  std::vector<Joint> joints;  // all that move, in the URDF's order
  std::vector<Part> parts;    // all that can be touched, in the URDF's order

  std::string body_name(const Part& part) const {
    return part.name.empty() ? name : name + "." + part.name;
  }
};

// Where a joint begins, instead of where its fixture says.
struct JointStart {
  FixtureId fixture = FixtureId::kNone;
  std::uint32_t joint = 0;
  double value = 0;  // m or rad
  Span span;
};

struct Scene {
  std::string name;     // of one that a task changes, as before
  Span span;
  std::string changed;  // by which statement of which task, and in what; empty: as declared
  bool broken = false;  // something was reported, and tasks here are not looked at
  RobotId robot = RobotId::kNone;
  std::array<double, 3> base_position{};
  bool is_placed = false;        // where the robot stands was said
  bool base_on_surface = false;  // no height was written
  Turn base_turn;
  std::vector<Quantity> joints;
  Span joints_span;
  double surface_z = 0;
  Span surface_span;  // of the height
  // The surface's height in the scene where the backdrop and where the cameras were written, with
  // their photos: those show it there.
  double backdrop_z = 0, cameras_z = 0;
  std::array<double, 4> area{};
  std::optional<Spelled> fixture;
  std::array<double, 3> fixture_position{};
  std::vector<FixtureId> fixtures;  // with joints
  // m: how much higher than they say its fixtures stand, as the surface is where it was copied.
  double fixtures_lift = 0;
  std::vector<Region> surface_regions, fixture_regions;  // about (0, 0, surface_z); in the mesh
  std::optional<Spelled> backdrop;
  bool backdrop_stands = false;  // where its mesh has it, for a surface at backdrop_z
  std::map<plan::CoverOf, Cover> covers;  // on the backdrop
  std::vector<View> views;                // the first is what a policy with one picture sees
  LightId light = LightId::kNone;
  double air_density = 0, air_viscosity = 0;
  Span air_span;
  double physics_hz = 0;
  Span physics_span;
  double friction = 0;
};

// ---- layouts
// --------------------------------------------------------------------------------------------------------

struct Cell {
  double x = 0, y = 0;
};
struct Cells {
  std::string name;
  Span span;
  std::vector<std::vector<Cell>> grids;  // one per spread; `distinct` never mixes two
  struct Spread {
    double x = 0, y = 0;
    Span span;
  };
  std::vector<Spread> spreads;  // by grid
};
struct Place {
  enum How : std::uint8_t { kAt, kDistinct, kRemaining, kOn, kIn };
  How how = kAt;
  std::vector<Spelled> what;  // a role, `distractors` or an object
  Cell at;                    // kAt
  std::string cells;          // kDistinct, kRemaining
  Spelled where = {};         // kOn, kIn: a role, an object or a region of a fixture
  Span span;
  bool is_put() const { return how == kOn || how == kIn; }
};
struct Orient {
  Spelled what;
  std::vector<Turn> turns;
};
// One object of a start that a file gives.
struct GivenPlace {
  Spelled what;  // a role that one object fills, or an object
  double x = 0, y = 0;
  std::optional<double> z;                        // of the model's origin; none: it is dropped
  Span z_span = {};                               // its cell
  std::optional<std::array<double, 4>> rotation;  // unit (w, x, y, z); none: its first rest
  bool is_same(const GivenPlace& other) const {
    return what.text == other.what.text && x == other.x && y == other.y && z == other.z &&
           rotation == other.rotation;
  }
};

// A joint of a fixture or of a robot in a start that a file gives.
struct GivenJoint {
  Spelled what;                          // "cabinet.top", "panda.joint1"
  FixtureId fixture = FixtureId::kNone;  // or
  RobotId robot = RobotId::kNone;
  std::uint32_t joint = 0;  // of Fixture::joints, of Robot::drives
  double value = 0;         // m or rad
  bool is_same(const GivenJoint& other) const {
    return fixture == other.fixture && robot == other.robot && joint == other.joint &&
           value == other.value;
  }
};

struct Layout {
  std::string name;
  LayoutId like = LayoutId::kNone;
  bool broken = false;  // as of an object
  Span span;
  std::vector<Cells> cells;
  std::vector<Place> places;
  bool by_rest = false;
  std::vector<Orient> orients;
  // The starts of a file, in place of cells, places and turns.
  std::vector<std::vector<GivenPlace>> given;
  std::vector<std::vector<GivenJoint>> given_joints;  // by start as well
  Span given_span;  // of the statement; none where there is no file
  double jitter = 0;
  Span jitter_span;
  double joints_jitter = 0;  // rad, of the robot's turning joints
  std::vector<JointStart> joint_starts;
  bool has_drop = false;
  bool begins_placed = false;  // `drop none`
  double drop = 0;
  double settle = 0;
  std::optional<std::uint64_t> expect;
  Span expect_span;
};

// ---- roles
// --------------------------------------------------------------------------------------------------------

struct Role {
  std::string name;
  Span span;
  bool is_set = false;
  bool takes_things = false;  // some task fills it with a part or a region
};

// ---- language
// -------------------------------------------------------------------------------------------------------

struct SlotRef {
  bool avoid = false;
  bool the = false;
  syntax::SlotCount count = syntax::SlotCount::kPlain;
  std::uint32_t number = 0;     // behind `all`, 0 for none
  Spelled name;                 // a role or an object
  RoleId role = RoleId::kNone;  // which
  std::optional<Spelled> category;
  Span span;
};
struct Template {
  std::string name;     // empty for words on the spot
  bool broken = false;  // as of an object
  Span span;
  std::string frame;  // the verb frame
  // A word as it is written, and in one case without the signs around it.
  struct Word {
    std::string text, plain;
  };
  struct Part {
    std::string literal;
    std::optional<SlotRef> slot;
    std::vector<Word> words = {};  // of the literal, but for articles
  };
  std::vector<Part> parts;
};

// ---- tasks
// ----------------------------------------------------------------------------------------------------------

struct PoseOverride {
  ObjectId object = ObjectId::kNone;
  Span span;  // of the object's name
  std::vector<Turn> turns;
};

// One configuration of a task.
struct Start {
  struct Placed {
    ObjectId object = ObjectId::kNone;
    double x = 0, y = 0;
    Turn turn;
    std::optional<double> z = {};  // of the model's origin; none: dropped from the layout's height
  };
  std::vector<Placed> placed;  // in the order of Task::objects()
  std::size_t given = 0;       // which of a file's starts it is, where the layout has a file
};

// A phrase that starts are chosen by: those in which it is clear.
struct ClearPhrase {
  RoleId role = RoleId::kSource;
  Spelled phrase;
};

// What a skill is done with, as written; what it is depends on the task.
struct SkillOperand {
  Spelled owner, name;  // "cabinet", "top_drawer"; no name: empty
  Span span;
};
struct SkillUse {
  plan::Skill skill = plan::Skill::kPick;
  SkillOperand what;
  plan::SkillRelation relation = plan::SkillRelation::kNothing;
  SkillOperand to;    // of `put`
  double amount = 0;  // rad, of `turn`
  Span span;
};

// `moves`, as written; who that is depends on the task.
struct Motion {
  Spelled what;
  plan::Way way = plan::Way::kBack;
  std::vector<std::array<double, 2>> points;  // m, from where it lies when the episode begins
  double speed = 0;                           // m/s
  Span span;
};

// What is said in place of the sentence before it, once a condition has held.
struct LaterSentence {
  TemplateId say = TemplateId::kNone;
  Span say_span;
  Metric when;       // read at the end of every step
  std::string text;  // computed
};

struct Task {
  std::string name;
  Span span;       // of its name
  Span decl_span;  // of the declaration
  FileId file;
  bool abstract = false;
  bool derived = false;  // by a `derive`, whose name text is `span`
  TaskId like = TaskId::kNone;
  TaskId baseline = TaskId::kNone;
  Span baseline_span;

  SceneId scene = SceneId::kNone;
  LayoutId layout = LayoutId::kNone;
  std::vector<ClearPhrase> clear;  // of the layout's starts, those in which these are
  MetricsId metrics = MetricsId::kNone;
  LightId light = LightId::kNone;  // overrides the scene's
  struct OtherCamera {
    CameraId camera = CameraId::kNone;
    std::optional<Spelled> as;  // the scene's view it takes the place of; else the first
  };
  std::vector<OtherCamera> cameras;  // in place of the scene's; a later one wins
  ObjectId source = ObjectId::kNone, target = ObjectId::kNone;
  struct Filled {
    RoleId role = RoleId::kNone;
    std::vector<ObjectId> objects;
    std::vector<Span> spans;  // by object
    Span span;                // of the statement
  };
  std::vector<Filled> others;  // other roles, ascending
  std::vector<ObjectId> distractors;
  std::vector<ObjectId> part_distractors;  // parts of fixtures that may be taken for another
  std::vector<Span> part_distractor_spans;
  std::vector<ObjectId> placed;  // in no role: what the layout puts into the scene by name
  TemplateId say = TemplateId::kNone;
  std::vector<LaterSentence> later;  // behind `say`, in their order
  std::map<RoleId, Spelled> refer;  // by which phrase
  std::vector<PoseOverride> poses;
  std::vector<JointStart> joint_starts;
  std::uint64_t horizon = 0;             // control steps
  std::optional<Quantity> horizon_time;  // the same, where it was said as a time
  std::uint32_t idle = 0;              // steps of standing still before the first of the horizon
  std::uint32_t delay = 0;             // steps until an action acts
  std::optional<Quantity> delay_time;  // the same, as a time
  Span delay_span;
  std::vector<Metric> overrides;  // `set`
  std::vector<SkillUse> solution;
  std::vector<Motion> motions;

  Span layout_span, say_span, distractors_span, horizon_span;
  std::vector<Span> distractor_spans;  // by distractor
  std::array<Span, 2> role_span;
  std::optional<std::string> allow_confounded;
  bool allow_absent = false;  // its text may tell of an object that is not in the scene
  bool keeps_absent = false;  // it keeps the text of a task that may

  // Computed.
  bool complete = false;  // every field is there and means something
  std::string prompt;
  std::uint32_t axes = 0;
  std::uint32_t ood = 0;
  std::vector<Metric> judged;     // the metrics it is judged by, in order
  std::span<const Start> starts;  // in Model::start_lists; equal tasks share one
  std::size_t layout_starts = 0;  // how many its layout has; `clear` keeps some of them

  // Rows of Model::objects below this are objects, the others parts and regions of fixtures.
  std::uint32_t declared_objects = 0xffffffffu;
  bool is_object(ObjectId id) const { return static_cast<std::uint32_t>(id) < declared_objects; }

  // In the order of the plan's bodies: source and target if there are any, other roles,
  // distractors, what the layout placed. Without parts and regions.
  std::vector<ObjectId> objects() const;
  // Parts and regions that fill roles, with those, in their order.
  std::vector<std::pair<RoleId, ObjectId>> things() const;
  // What fills a role, a part or a region, too; none for one that nothing fills.
  std::vector<ObjectId> objects_in(RoleId role) const;
  // kNone for an object that fills none: a distractor, or one that was placed.
  RoleId role_of(ObjectId object) const;
  bool has_both() const {
    return source != ObjectId::kNone && target != ObjectId::kNone && is_object(source) &&
           is_object(target);
  }
  // Where to point for what holds of this task: at what was said, unless another file says it,
  // whose author is not the one who chose it here.
  const Span& place(const Span& said) const {
    return said.is_none() || !(said.file == file) ? span : said;
  }
  const Spelled* refer_of(RoleId role) const {
    const auto at = refer.find(role);
    return at == refer.end() ? nullptr : &at->second;
  }
};

// A variant that a `sample` took without the baseline that it is compared with.
struct CutComparison {
  TaskId task = TaskId::kNone;
  Span sample;
  std::size_t episodes = 0;  // so many drawn starts of it; 0: all that it has
};

struct TaskSet {
  std::string name;
  Span span;
  std::vector<TaskId> members;
  std::vector<CutComparison> cuts;
  bool broken = false;  // its text is torn
};

struct Suite {
  std::string name;
  Span span;
  std::string prefix;
  DatasetId trained_on = DatasetId::kNone;
  std::vector<TaskId> members;
  std::map<TaskId, std::vector<std::uint32_t>> drawn;  // of members that are sampled: which starts
  std::vector<std::uint32_t> seeds;
  struct Expect {
    std::uint64_t tasks = 0, episodes = 0;
    Span span;
  };
  std::optional<Expect> expect;
  std::vector<CutComparison> cuts;       // of members whose baseline is no member
  std::vector<QuestionSetId> questions;  // that its members are asked
  bool broken = false;                   // its text is torn, or has no `tasks`

  // What it runs of a member: numbers of starts, ascending.
  std::vector<std::uint32_t> starts_of(TaskId member, const Task& task) const;
};

struct Model {
  Table<DatasetId, Dataset> datasets;
  Table<AttributeId, Attribute> attributes;
  std::vector<std::string> facts;
  Table<ObjectId, Object> objects;
  Table<RobotId, Robot> robots;
  Table<CameraId, Camera> cameras;
  Table<LightId, Light> lights;
  Table<FixtureId, Fixture> fixtures;
  Table<SceneId, Scene> scenes;
  Table<LayoutId, Layout> layouts;
  Table<TemplateId, Template> templates;
  ExprArena exprs;
  Table<PredicateId, Predicate> predicates;
  Table<MetricsId, Metrics> metrics;
  Table<RoleId, Role> roles;  // source and target are the first two
  bool has_part_distractors = false;  // some task has a part among its distractors
  Table<TaskId, Task> tasks;
  Table<SetId, TaskSet> sets;
  Table<SuiteId, Suite> suites;
  std::vector<Space> spaces;
  Table<QuestionSetId, QuestionSet> question_sets;
  std::vector<AskedQuestion> asked;            // ascending by task, set and family
  std::vector<LeftOut> left_out;               // as well
  std::deque<std::vector<Start>> start_lists;  // a deque: spans into it stay valid
};

}  // namespace probe::sema
