// The typed tree of one .probe file: one struct per declaration kind and statement kind of
// dsl/grammar.ebnf, in the order of the text. Says what was written, never what it means: names are
// not resolved, units not converted. Every view (Name::text, Quantity::digits ...) points into the
// SourceFile and lives as long as its SourceSet. Expressions, queries, conditions and sets are
// nodes in arrays of File, referred to by index, children first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/source/source.h"
#include "runtime/plan/questions.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/skills.h"

namespace probe::syntax {

// ---- leaves
// ---------------------------------------------------------------------------------------------------------

struct Name {
  Span span;
  std::string_view text;
};

// `widowx.base_link`, `language.action`
struct Path {
  Span span;
  std::vector<Name> parts;  // at least one
};

enum class Unit : std::uint8_t {
  kNone,
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) id,
#include "compiler/syntax/units.def"
  kUnknown,  // P0301 has been reported; say nothing more
};

std::string_view to_text(Unit unit);  // "" for kNone and kUnknown

// An exact decimal: sign, digits as written ("20.6", "1e-6"), unit. Conversion happens once, later.
struct Quantity {
  Span span;  // sign to unit
  std::string_view digits;
  Unit unit = Unit::kNone;
  bool negative = false;
  std::string_view binder = {};  // of a `derive`, in place of all of it
};

struct Int {
  Span span;
  std::uint64_t value = 0;
  std::string_view binder = {};  // of a `derive`, in place of the value
};

// `value` is what the escapes mean; `raw` stands between the quotes.
struct Text {
  Span span;  // with the quotes
  std::string_view raw;
  std::string value;
};

// How many of a role a slot speaks of.
enum class SlotCount : std::uint8_t {
  kPlain,  // of all that fill it: `{the goods}`
  kBoth,   // `{both goods}`
  kAll,    // `{all goods}`, `{all three goods}`
  kOther,  // `{the other goods}`: the one that was not said before
};
// One piece of a text with slots: literal bytes, or
// "{" [avoid] [the] [both | all [number] | other] name [":" category] "}".
struct Slot {
  Span span;  // with the braces
  bool avoid = false;
  bool the = false;
  SlotCount count = SlotCount::kPlain;
  std::uint32_t number = 0;      // behind `all`, 0 for none
  Name name;                     // a role, an object, or a binder of `derive`
  std::optional<Name> category;  // accepts only this value of attribute `category`
};
using TemplatePart = std::variant<std::string, Slot>;
struct TemplateText {
  Text text;
  std::vector<TemplatePart> parts;  // in order; literal parts are not empty
};

struct Point {
  Span span;  // with the parentheses
  std::vector<Quantity> coordinates;
};

enum class Turn : std::uint8_t { kRoll, kPitch, kYaw };
struct Angle {
  Span span;
  Turn turn = Turn::kYaw;
  Quantity value;
};
// `roll 90deg yaw 15deg`: extrinsic turns about x, y, z.
struct Pose {
  Span span;
  std::vector<Angle> angles;  // at least one
};

// Indices into the arrays of File.
struct ExprId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;
};
struct SetExprId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;
};
struct QueryId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;
};
struct TaskSetId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;
};
struct CondId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;
};

// ---- queries over attributes
// ----------------------------------------------------------------------------------------

struct QueryFact {  // `rabbit_favorite`
  Name fact;
};
struct QueryValue {  // `color orange`
  Name attribute;
  Name value;
};
struct QueryRelation {  // `between(plate, bowl)`
  Name relation;
  std::vector<Name> objects;
};
struct QueryNot {
  QueryId operand;
};
struct QueryAnd {
  QueryId left, right;
};
struct QueryOr {
  QueryId left, right;
};
struct Query {
  Span span;
  std::variant<QueryFact, QueryValue, QueryRelation, QueryNot, QueryAnd, QueryOr> node;
};

// ---- expressions of predicates and metrics
// --------------------------------------------------------------------------

enum class Quantifier : std::uint8_t { kAny, kAll, kNo };
enum class UnaryOp : std::uint8_t { kNot, kOnce, kAlways, kNegate };
enum class BinaryOp : std::uint8_t {
  kOr,
  kAnd,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
};

struct ExprNumber {
  Quantity value;  // never signed; a minus is UnaryOp::kNegate
};
struct ExprName {
  Name name;
};
struct ExprPath {  // `cabinet.top_drawer`, `target.inside`
  Name owner, name;
};
struct Argument {
  Span span;
  std::optional<Name> name;  // `clearance: 6cm`
  ExprId value;
};
struct ExprCall {
  Name callee;
  std::vector<Argument> arguments;
};
struct ExprVector {  // `(0, 0, 1)`
  std::array<ExprId, 3> parts;
};
struct ExprUnary {
  UnaryOp op;
  Span op_span;
  ExprId operand;
};
struct ExprBinary {
  BinaryOp op;
  Span op_span;
  ExprId left, right;
};
struct ExprHold {  // `operand for 5 steps`
  ExprId operand;
  Int steps;
  Span for_span;  // `for 5 steps`
};
struct ExprBlock {  // `any { ... }`, `all { ... }`: one condition per line
  Quantifier quantifier;
  std::vector<ExprId> conditions;
};
struct ExprQuantified {  // `no x in bodies - {a, b}: body`
  Quantifier quantifier;
  Name variable;
  SetExprId set;
  ExprId body;
};
struct Expr {
  Span span;
  std::variant<ExprNumber, ExprName, ExprPath, ExprCall, ExprVector, ExprUnary, ExprBinary,
               ExprHold, ExprBlock, ExprQuantified>
      node;
};

// ---- sets of bodies (in quantifiers) and of tasks
// -------------------------------------------------------------------

enum class SetOp : std::uint8_t { kUnion, kIntersection, kDifference };  // | & -

struct SetNames {  // `{a, b}`
  std::vector<Name> names;
};
struct SetName {  // `fingers`
  Name name;
};
struct SetWhole {  // `whole target`: all bodies of the thing that it is, or is of
  Name name;
};
struct SetBinary {
  SetOp op;
  SetExprId left, right;
};
struct SetExpr {
  Span span;
  std::variant<SetNames, SetName, SetWhole, SetBinary> node;
};

struct TaskSetNames {
  std::vector<Name> names;
};
struct TaskSetName {
  Name name;
};
struct TaskSetVariants {  // `variants of core`
  TaskSetId of;
};
struct TaskSetSample {  // `sample 12 of x seed 7`
  Int count;
  TaskSetId of;
  Int seed;
  bool with_baselines = false;
};
struct TaskSetBinary {
  SetOp op;
  TaskSetId left, right;
};
struct TaskSetWhere {
  TaskSetId set;
  CondId condition;
};
struct TaskSet {
  Span span;
  std::variant<TaskSetNames, TaskSetName, TaskSetVariants, TaskSetSample, TaskSetBinary,
               TaskSetWhere>
      node;
};

enum class CondKind : std::uint8_t { kAxis, kUses, kOod, kHas, kScene, kMetrics };
struct CondTest {  // `axis language.action`, `ood source`
  CondKind kind;
  Path path;
};
struct CondNot {
  CondId operand;
};
struct CondAnd {
  CondId left, right;
};
struct CondOr {
  CondId left, right;
};
struct Cond {
  Span span;
  std::variant<CondTest, CondNot, CondAnd, CondOr> node;
};

struct Readout {
  Span span;  // read-out word to the end of the expression
  plan::Readout kind = plan::Readout::kAtEnd;
  Span kind_span;
  ExprId expr;
};

// ---- the world
// ------------------------------------------------------------------------------------------------------
// Every statement starts with `span`, the whole statement.

struct UseDecl {
  Text path;
  FileId file = {};  // what the loader found there
};

struct Relation {  // `carrot on plate`
  Span span;
  Name subject, preposition, object;
};
struct RelationsStmt {
  Span span;
  std::vector<Relation> relations;
};
struct DatasetDecl {
  Name name;
  Text title;
  std::vector<RelationsStmt> body;
};

struct AttributeDecl {
  Name name;
  std::vector<Name> values;
};

struct FactsDecl {
  std::vector<Name> names;
};

struct MeshStmt {
  Span span;
  Text path;
};
struct BoxSizeStmt {  // `box 3cm x 3cm x 3cm`
  Span span;
  Quantity x, y, z;
};
struct BoxCornersStmt {  // `box (..) .. (..)`
  Span span;
  Point low, high;
};
struct DensityStmt {
  Span span;
  Quantity value;
};
struct MassStmt {  // `mass 0.2kg`, `mass 0.2kg com (..) inertia (xx, yy, zz, xy, xz, yz)`
  Span span;
  Quantity value;
  std::optional<Point> centre, inertia;  // both or neither
};
struct ObjectDampingStmt {  // `damping 0.1Ns/m`, `damping 0.1Ns/m 0.001Nms/rad`
  Span span;
  Quantity shift;                // or of its turn, where it is the only one
  std::optional<Quantity> turn;
};
struct FrictionStmt {
  Span span;
  Quantity value;
};
struct ScaleStmt {  // `scale 1.2`
  Span span;
  Quantity factor;
};
struct PaintStmt {  // `paint red`, `paint (0.9, 0.4, 0.1)`
  Span span;
  std::variant<Name, Point> color;
};
struct TextureStmt {  // `texture "wood" 10cm`; of a scene `texture surface "wood" 40cm`
  Span span;
  std::optional<Name> of;
  Text picture;
  std::optional<Quantity> side;
};
struct IsStmt {
  Span span;
  std::vector<Name> facts;
};
struct MaybeStmt {
  Span span;
  std::vector<Name> facts;
};
struct SeenInStmt {
  Span span;
  std::vector<Name> datasets;
};
struct UnseenStmt {
  Span span;
};
struct RestStmt {
  Span span;
  std::vector<Pose> poses;
};
struct NameStmt {
  Span span;
  Text text;
  bool bare = false;
};
struct PhraseStmt {
  Span span;
  Name name;
  Name axis;  // appearance, commonsense or another
  Text text;
  bool bare = false;
  QueryId means;
};
struct AttributeStmt {  // `color silver, green`
  Span span;
  Name attribute;
  std::vector<Name> values;
};
struct RegionStmt {  // `region inside of top_drawer box (..) .. (..)`
  Span span;
  Name name;
  std::optional<Name> of;  // of a fixture a part or itself, of a scene `surface` or `fixture`
  Point low, high;
  std::optional<Point> at;   // of a turned one: where its box's own origin stands
  std::optional<Pose> turn;  // behind `at`
  std::optional<Text> text;  // of a fixture's: in instructions
};
using ObjectStmt =
    std::variant<MeshStmt, BoxSizeStmt, BoxCornersStmt, DensityStmt, MassStmt,
                 ObjectDampingStmt, FrictionStmt, ScaleStmt, PaintStmt, TextureStmt, IsStmt,
                 MaybeStmt, SeenInStmt, UnseenStmt, RestStmt, RegionStmt, NameStmt, PhraseStmt, AttributeStmt>;
struct ObjectDecl {
  Name name;
  std::optional<Name> like;
  std::vector<ObjectStmt> body;
};
struct ExtendDecl {  // `extend object plate { material ceramic }`
  Name object;
  std::vector<ObjectStmt> body;
};

struct UrdfStmt {
  Span span;
  Text path;
};
struct SignedAxis {  // `+y`
  bool negative = false;
  Name axis;
};
struct TcpStmt {  // `tool points +z`
  Span span;
  Name link;
  std::optional<SignedAxis> points;
};
struct Finger {  // `left_finger_link opens +y`
  Span span;
  Name link;
  SignedAxis opens;
};
struct FingersStmt {  // none for `fingers none`
  Span span;
  std::vector<Finger> fingers;
};

// The numbers of a control law.
struct ControlKpStmt {  // one for all six directions, or (shift, turn), or six
  Span span;
  Point values;
};
struct ControlDampingStmt {
  Span span;
  Point values;
};
struct ControlOutputStmt {
  Span span;
  Point values;
};
struct ControlNullStmt {
  Span span;
  Quantity value;
};
struct ControlUncoupleStmt {
  Span span;
};
struct ControlRampStmt {
  Span span;
  Quantity value;
};
struct ControlHomeStmt {
  Span span;
  Point positions;
};
struct ControlFromStmt {
  Span span;
  Name what;  // target, measured
};
struct ControlMostStmt {
  Span span;
  Quantity value;
};
struct ControlPathStmt {  // `arm_path (1.5, 2, 50)`: speed, acceleration, jerk
  Span span;
  bool of_arm = true;
  Point limits;
};
using ControlSetting =
    std::variant<ControlKpStmt, ControlDampingStmt, ControlOutputStmt, ControlNullStmt,
                 ControlUncoupleStmt, ControlRampStmt, ControlHomeStmt, ControlFromStmt,
                 ControlMostStmt, ControlPathStmt>;
struct ControlStmt {  // `control osc_pose 20Hz { kp 150; home (..) }`
  Span span;
  Name law;
  Quantity rate;
  std::vector<ControlSetting> body;
};
struct ReachStmt {
  Span span;
  Quantity least, most;
};
struct DriveStmt {  // `drive waist, shoulder stiffness 1200Nm/rad damping 40Nms/rad limit 30Nm`
  Span span;
  std::vector<Name> joints;
  std::optional<Quantity> stiffness, damping, limit, friction, armature;
};
struct GripStmt {  // `grip 1.5cm .. 3.7cm friction 1 patch 4mm`
  Span span;
  Quantity closed, open;                           // finger joint targets
  std::optional<Quantity> friction;                // of the fingers
  std::optional<Quantity> patch;                   // radius of the torsional contact patch
  std::optional<Quantity> pace, stiffness, limit;  // of a law by efforts
};
using RobotStmt =
    std::variant<UrdfStmt, TcpStmt, FingersStmt, ControlStmt, ReachStmt, DriveStmt, GripStmt>;
struct RobotDecl {
  Name name;
  std::optional<Name> like;
  std::vector<RobotStmt> body;
};

enum class MountKind : std::uint8_t { kLook, kQuat };
struct MountStmt {
  Span span;
  Path frame;
  Point at;
  MountKind kind = MountKind::kLook;
  Point direction;  // `look`: three plain numbers; `quat`: four
};
struct ImageStmt {
  Span span;
  Int width, height;
  std::optional<Int> samples;  // a pixel
};
struct LensStmt {
  Span span;
  std::vector<Quantity> values;
};
struct SensorStmt {  // `sensor noise 0.02 blur 1.5px exposure 0.7 patch (..) .. (..) dropped 0.1`
  Span span;         // `none`: nothing of it
  std::optional<Quantity> noise, blur, exposure, dropped;
  std::optional<Point> patch_low, patch_high;
  bool mirrored = false;
};
struct CameraJitterStmt {  // `jitter 3cm 5deg`
  Span span;
  Quantity place, turn;
};
using CameraStmt = std::variant<MountStmt, ImageStmt, LensStmt, SensorStmt, CameraJitterStmt>;
struct CameraDecl {
  Name name;
  std::optional<Name> like;
  std::vector<CameraStmt> body;
};

struct AmbientStmt {
  Span span;
  Quantity value;
  std::optional<Int> occlusion;  // rays a sample
};
struct SunStmt {
  Span span;
  Point direction;
  Quantity power;
  std::optional<Quantity> specular;  // under `shading vertex`
  bool shadow = false;
};
struct LampStmt {  // `spot at (1m, 1m, 4m) along (0, 0, -1) power 0.8`, `headlight power 0.4`
  Span span;
  std::optional<Point> place, direction;  // of a spot
  Quantity power;
  std::optional<Quantity> specular, ambient, cutoff, exponent;
  std::optional<Point> fade;
};
struct ShadingStmt {  // `shading vertex`
  Span span;
};
struct LightColorStmt {  // `color (1, 0.8, 0.6)`
  Span span;
  Point color;
};
using LightStmt = std::variant<AmbientStmt, SunStmt, LampStmt, ShadingStmt, LightColorStmt>;
struct LightDecl {
  Name name;
  std::vector<LightStmt> body;
};

struct FixtureAtStmt {  // `at (-10cm, 25cm, 87cm) yaw 180deg`
  Span span;
  Point at;
  std::optional<Pose> turn;
};
struct FixtureJointStmt {  // `joint top friction 2N damping 5Ns/m stiffness 30N/m at 0cm start 4cm`
  Span span;
  Name joint;
  std::optional<Quantity> friction, damping, stiffness, rest, armature, start;
  bool stay = false;
};
struct PartStmt {  // `part top_drawer link top name "top drawer"`
  Span span;
  Name name;
  Name link;
  std::optional<Text> text;
  std::vector<ObjectStmt>
      body;  // `{ category drawer; phrase upper spatial "upper drawer" means .. }`
};
struct ShownStmt {  // `shown glow while knob >= 0.5rad`
  Span span;
  Name link;
  Name joint;
  bool from_below = false;  // `<=`
  Quantity value;
};
using FixtureBodyStmt = std::variant<UrdfStmt, FixtureAtStmt, FrictionStmt, FixtureJointStmt,
                                     PartStmt, RegionStmt, ShownStmt>;
struct FixtureDecl {
  Name name;
  std::optional<Name> like;
  std::vector<FixtureBodyStmt> body;
};

struct SceneRobotStmt {  // `robot widowx at (..) yaw ..`; in a copy the robot, or its place, alone
  Span span;
  std::optional<Name> robot;
  std::optional<Point> at;  // two or three coordinates
  Quantity yaw;             // behind `at`
};
struct JointsStmt {  // `joints (-0.018rad, 0.04rad, 3.7cm)`: initial positions, in the URDF's order
  Span span;
  Point positions;
};
struct SurfaceStmt {
  Span span;
  Quantity height;
  Point low, high;
};
struct FixtureStmt {
  Span span;
  Text mesh;
  Point at;
};
struct SceneFixturesStmt {  // `fixture cabinet, stove`: with joints
  Span span;
  std::vector<Name> fixtures;
};
struct BackdropStmt {  // a mesh that is seen and not touched
  Span span;
  Text mesh;
  bool stands = false;  // where it has its table, the surface wherever it is
};
struct SceneCamera {  // `third_view as outside overlay "photo.png"`
  Name camera;
  std::optional<Name> as;  // what policies call it; else the camera's name
  std::optional<Text> overlay;
};
struct SceneCameraStmt {
  Span span;
  std::vector<SceneCamera> cameras;
};
struct UseLightStmt {
  Span span;
  Name light;
};
struct PhysicsStmt {
  Span span;
  Quantity rate;
  Quantity friction;
  std::optional<Quantity> air, viscosity;
  bool window_step = false;
};
using SceneStmt =
    std::variant<SceneRobotStmt, JointsStmt, SurfaceStmt, FixtureStmt, SceneFixturesStmt,
                 RegionStmt, BackdropStmt, TextureStmt, SceneCameraStmt, UseLightStmt, PhysicsStmt>;
struct SceneDecl {
  Name name;
  std::optional<Name> like;
  std::vector<SceneStmt> body;
};

struct CellsStmt {  // `cells corners = grid 2 x 2 at (..) spread (..), (..)`
  Span span;
  Name name;
  Int nx, ny;  // cells along x, along y
  Point at;
  std::vector<Point> spreads;
};
struct PlaceAtStmt {
  Span span;
  std::vector<Name> names;
  Point at;
};
enum class PlaceHow : std::uint8_t { kDistinct, kRemaining };
struct PlaceInStmt {
  Span span;
  std::vector<Name> names;
  PlaceHow how = PlaceHow::kDistinct;
  Name cells;
};
struct PlaceOnStmt {  // `place source on target`, `place spoon in cabinet.inside_top`
  Span span;
  std::vector<Name> names;
  bool in = false;  // else on
  Name where;
};
struct OrientByRestStmt {
  Span span;
};
struct OrientStmt {
  Span span;
  Name what;
  std::vector<Pose> poses;
};
struct JitterStmt {
  Span span;
  Quantity value;
};
struct JointsJitterStmt {  // `joints jitter 2deg`
  Span span;
  Quantity value;
};
struct StartStmt {  // `start cabinet.top 4cm`: where a fixture's joint begins
  Span span;
  Name fixture, joint;  // empty: every copied one
  Quantity value;
  bool none = false;  // a copied one is taken away
};
struct DropStmt {
  Span span;
  Quantity height;
  std::optional<Quantity> settle;
  bool none = false;  // an episode begins as things are placed
};
struct StartsStmt {
  Span span;
  Text path;    // beside the file that names it
  FileId file;  // what it names; none: it cannot be read
};
struct ExpectEpisodesStmt {
  Span span;
  Int episodes;
};
using LayoutStmt =
    std::variant<CellsStmt, PlaceAtStmt, PlaceInStmt, PlaceOnStmt, OrientByRestStmt, OrientStmt,
                 StartsStmt, JitterStmt, JointsJitterStmt, StartStmt, DropStmt, ExpectEpisodesStmt>;
struct LayoutDecl {
  Name name;
  std::optional<Name> like;
  std::vector<LayoutStmt> body;
};

// ---- language and judgement
// -----------------------------------------------------------------------------------------

struct TemplateDecl {
  Name name;
  std::optional<Name> frame;
  TemplateText text;
};

enum class ParamType : std::uint8_t {
  kObject,
  kBody,
  kPart,
  kRegion,
  kLength,
  kAngle,
  kTime,
  kImpulse,
  kNumber
};
struct Param {
  Span span;
  Name name;
  ParamType type = ParamType::kObject;
  Span type_span;
  std::optional<ExprId> default_value;
};
struct PredicateDecl {
  Name name;
  std::vector<Param> params;
  ExprId body;
  bool is_relation = false;  // `relation`: of where things start
  std::vector<Text> words;   // of a relation: what says it
};

struct MetricStmt {
  Span span;
  Name name;
  Readout readout;
};
struct MetricsDecl {
  Name name;
  std::optional<Name> like;
  std::vector<MetricStmt> body;
};

// ---- tasks, variants, suites
// ----------------------------------------------------------------------------------------

struct RoleDecl {  // `role helper`, `role goods: set`
  Name name;
  bool is_set = false;
};
enum class TaskField : std::uint8_t { kScene, kSource, kTarget, kMetrics, kLight };
struct FieldStmt {  // `scene table`
  Span span;
  TaskField field = TaskField::kScene;
  Name value;  // of a role also `cabinet.top_drawer`
};
struct TaskSceneStmt {  // `scene { robot panda }`, `scene table { light l }`: with these changed
  Span span;
  std::optional<Name> scene;  // else the one that is copied
  std::vector<SceneStmt> body;
};
struct ClearPhrase {  // `side of source`
  Name phrase;
  Name role;
};
struct TaskLayoutStmt {  // `layout grid where clear side of source`
  Span span;
  Name layout;
  std::vector<ClearPhrase> clear;
};
struct TaskCameraStmt {  // `camera near_wrist as wrist`: in place of the scene's camera of that
                         // name
  Span span;
  Name camera;
  std::optional<Name> as;  // else in place of the first
};
struct DistractorsStmt {  // `none` is the empty list; `3 of (a, b, c, d) seed 7`
  Span span;
  std::vector<Name> objects;
  std::optional<Int> count, seed;  // so many of them, drawn
};
struct RoleStmt {  // `helper spoon`, `goods carrot, spoon`; `none` is the empty list
  Span span;
  Name role;
  std::vector<Name> objects;
};
struct SayStmt {
  Span span;
  std::variant<Name, TemplateText> what;  // a template by name, or words on the spot
};
struct ThenStmt {  // `then say put_in when opened(target)`; `then none` takes copied ones away
  Span span;
  std::optional<std::variant<Name, TemplateText>> what;  // as of `say`
  ExprId when;
  Span when_span;
};
struct ReferStmt {
  Span span;
  Name role;
  Name phrase;
};
struct PoseStmt {
  Span span;
  Name object;
  std::vector<Pose> poses;
};
struct HorizonStmt {  // `horizon 60 steps`, `horizon 12s`
  Span span;
  std::variant<Int, Quantity> how_long;
};
struct IdleStmt {
  Span span;
  Int steps;
};
struct DelayStmt {  // `delay 2 steps`, `delay 400ms`
  Span span;
  std::variant<Int, Quantity> how_long;
};
struct MovesStmt {  // `moves mug along (10cm, 0cm) at 5cm/s once`
  Span span;
  Name what;
  plan::Way way = plan::Way::kBack;
  std::vector<Point> points;  // empty: `none`
  Quantity speed;
};
// What a skill is done with: `source`, `cabinet.top_drawer`.
struct SkillOperand {
  Span span;
  Name owner;
  std::optional<Name> name;
};
struct SkillStmt {  // `put source in cabinet.inside_top`, `turn stove.left_knob by 90deg`
  Span span;
  plan::Skill skill = plan::Skill::kPick;
  SkillOperand what;
  plan::SkillRelation relation = plan::SkillRelation::kNothing;
  std::optional<SkillOperand> to;  // of `put`
  std::optional<Quantity> amount;  // of `turn`
};
using SkillNode = std::variant<SkillStmt>;
struct SolutionStmt {  // `none` is the empty list
  Span span;
  std::vector<SkillNode> skills;
};
using TaskStmt = std::variant<FieldStmt, TaskSceneStmt, TaskLayoutStmt, TaskCameraStmt, DistractorsStmt, SayStmt,
                              ThenStmt, ReferStmt, PoseStmt, StartStmt, HorizonStmt, IdleStmt, DelayStmt,
                              MovesStmt, SolutionStmt, MetricStmt, RoleStmt>;

struct TaskDecl {
  bool abstract = false;
  Name name;
  std::optional<Name> like;
  std::optional<Name> against;
  std::vector<TaskStmt> body;
};
struct VariantDecl {
  Name name;
  Name of;
  std::optional<Name> against;
  std::vector<TaskStmt> body;
};
struct VariantsMember {
  Span span;
  Name name;
  std::vector<TaskStmt> body;
};
struct VariantsDecl {
  Name of;
  std::vector<VariantsMember> members;
};

struct BinderPhrases {  // `p in clear phrases appearance of source`
  Name axis;
  Name role;
  bool clear = false;  // only those that describe their object alone
};
struct BinderTemplates {  // `w in templates of put`
  Name frame;
};
struct BinderObjects {  // `o in objects (carrot, spoon)`, `p in parts (cabinet.top_drawer)`
  std::vector<Name> objects;
};
struct BinderDeclared {  // `l in lights (day, night)`
  enum class Of : std::uint8_t { kLights, kCameras, kScenes, kRobots, kFixtures };
  Of of = Of::kLights;
  std::vector<Name> names;
};
struct BinderNumbers {  // `s in 0.8, 1, 1.2`, `k in 0 .. 6`
  std::vector<Quantity> values;
  std::optional<Quantity> last;  // of a range, whose first is the one of `values`
};
struct BinderDistractors {  // `o in distractors of t`, `o in goods of t`, `p in parts of cabinet`
  Name role;
  Name task;
};
struct BinderTasks {  // `t in core`; a `where` belongs to the derive
  TaskSetId tasks;
};
struct Binder {
  Span span;
  Name name;
  std::variant<BinderPhrases, BinderTemplates, BinderObjects, BinderDeclared, BinderNumbers,
               BinderDistractors, BinderTasks>
      over;
};
struct DeriveDecl {
  TemplateText name;  // slots are binders
  std::vector<Binder> binders;
  std::optional<CondId> where;
  std::vector<TaskStmt> body;
};

struct SetDecl {
  Name name;
  TaskSetId tasks;
};

// ---- questions

// One piece of a question: literal bytes, or "{" [the | a] name ["of" name] "}".
struct Placeholder {
  enum class Article : std::uint8_t { kNone, kThe, kA };
  Span span;  // with the braces
  Article article = Article::kNone;
  std::optional<Name> what;  // `phrase of`, `name of`, `category of`
  Name of;                   // instruction, a role, an object, or what `for` binds
};
using QuestionPart = std::variant<std::string, Placeholder>;
struct QuestionText {
  Text text;
  std::vector<QuestionPart> parts;  // in order; literal parts are not empty
};

// `objects`, `objects and 2 absent`, `catalogue`
struct ObjectPool {
  Span span;
  bool is_catalogue = false;
  std::optional<Int> absent;
};

struct AnswerOne {  // `source`: of a choice or a point
  Name who;
};
struct AnswerPresent {  // `present(o)`
  Name who;
};
struct AnswerBeside {  // `left(source, target)`, `nearer(source, target)`
  bool is_nearer = false;
  Name a, b;
};
struct AnswerCount {  // `count(category of source)`
  Name attribute, who;
};
struct AnswerMentions {  // `mentions(source, target)`: what is moved, and where to
  Name what, to;
};
struct AnswerTruth {  // a metric's name, or a condition: judged at the end
  ExprId expr;
};
using Answer =
    std::variant<AnswerOne, AnswerPresent, AnswerBeside, AnswerCount, AnswerMentions, AnswerTruth>;

struct QuestionStmt {
  Span span;
  plan::QuestionForm form = plan::QuestionForm::kChoice;
  Name name;
  QuestionText text;
  std::optional<Name> binder;  // `for o in`
  ObjectPool over;             // when there is a binder
  plan::QuestionMoment moment = plan::QuestionMoment::kStart;
  Span answer_span;
  Answer answer;
  std::optional<ObjectPool> among;  // of a choice
  std::optional<Int> pixels;
  std::optional<CondId> where;
};
struct QuestionsDecl {
  Name name;
  std::vector<QuestionStmt> body;
};

struct SuiteTasksStmt {
  Span span;
  TaskSetId tasks;
};
// So many starts of these tasks, in place of all of each.
struct SuiteSampleStmt {
  Span span;
  Int count;
  TaskSetId of;
  Int seed;
  bool with_baselines = false;
};
struct PrefixStmt {
  Span span;
  Text prefix;
};
struct SeedsStmt {
  Span span;
  std::vector<Int> seeds;
};
struct ExpectTasksStmt {
  Span span;
  Int tasks, episodes;
};
struct SuiteQuestionsStmt {
  Span span;
  std::vector<Name> sets;
};
using SuiteStmt = std::variant<SuiteTasksStmt, SuiteSampleStmt, PrefixStmt, SeedsStmt,
                               ExpectTasksStmt, SuiteQuestionsStmt>;
struct SuiteDecl {
  Name name;
  std::optional<Name> trained_on;
  std::vector<SuiteStmt> body;
};

// ---- spaces

struct SpaceRange {
  Quantity low, high;
};
// What varies about a task, and how far; each line is one axis or several.
struct SpaceLightStmt {  // `light ambient 0.05 .. 0.6, power 0.2 .. 3, direction within 60deg`
  Span span;
  std::optional<SpaceRange> ambient, power;
  std::optional<Quantity> direction;
};
struct SpaceCameraStmt {  // `camera third_view within (5cm, 5cm, 5cm), 8deg`
  Span span;
  Name view;
  std::optional<Point> place;
  std::optional<Quantity> turn;
};
struct SpacePlaceStmt {  // `place source in disc 12cm, target in disc 12cm`
  struct Disc {
    Name what;
    Quantity radius;
  };
  Span span;
  std::vector<Disc> discs;
};
struct SpaceClutterStmt {  // `clutter 0 .. 6 from (nut, rabbit)`
  Span span;
  Int least, most;
  std::vector<Name> from;
};
struct SpaceWordsStmt {  // `words templates of put, phrases of source`
  struct Pool {
    bool is_templates = false;
    Name of;  // a frame or a role
  };
  Span span;
  std::vector<Pool> pools;
};
struct SpaceSensorStmt {  // `sensor noise 0 .. 0.1, blur 0px .. 3px, exposure 0.2 .. 2`
  Span span;
  std::optional<SpaceRange> noise, blur, exposure;
};
struct SpaceDelayStmt {  // `delay 0ms .. 600ms`
  Span span;
  SpaceRange range;
};
using SpaceStmt = std::variant<SpaceLightStmt, SpaceCameraStmt, SpacePlaceStmt, SpaceClutterStmt,
                               SpaceWordsStmt, SpaceSensorStmt, SpaceDelayStmt>;
struct SpaceDecl {
  Name name;
  Name of;  // the task
  std::vector<SpaceStmt> body;
};

// ---- file
// -----------------------------------------------------------------------------------------------------------

struct Allow {  // @allow(confounded, "why")
  Span span;
  Name what;
  Text reason;
  Span member;  // of `variants of`, above which it stands; none: above the declaration
};

using DeclNode =
    std::variant<UseDecl, DatasetDecl, AttributeDecl, FactsDecl, ObjectDecl, ExtendDecl, RobotDecl,
                 CameraDecl, LightDecl, FixtureDecl, SceneDecl, LayoutDecl, TemplateDecl,
                 PredicateDecl, MetricsDecl, RoleDecl, TaskDecl, VariantDecl, VariantsDecl,
                 DeriveDecl, SetDecl, QuestionsDecl, SuiteDecl, SpaceDecl>;

struct Decl {
  Span span;  // keyword to the last token
  std::vector<std::string_view>
      docs;  // text of each `##` line above, without the marks and one blank
  std::vector<Allow> allows;
  DeclNode node;
  bool complete =
      true;  // false: a syntax error in its head or body was reported; statements may be missing
};

struct File {
  FileId id;
  std::vector<Decl> decls;  // in the order of the text

  std::vector<Expr> exprs;
  std::vector<SetExpr> set_exprs;
  std::vector<Query> queries;
  std::vector<TaskSet> task_sets;
  std::vector<Cond> conds;

  const Expr& operator[](ExprId id_) const { return exprs[id_.value]; }
  const SetExpr& operator[](SetExprId id_) const { return set_exprs[id_.value]; }
  const Query& operator[](QueryId id_) const { return queries[id_.value]; }
  const TaskSet& operator[](TaskSetId id_) const { return task_sets[id_.value]; }
  const Cond& operator[](CondId id_) const { return conds[id_.value]; }
};

}  // namespace probe::syntax
