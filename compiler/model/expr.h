// Predicates and metrics with names resolved and types checked: nodes in one arena, children before
// parents. Says what is measured, never how; compiler/lower unrolls it for the bodies of a task.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/model/ids.h"
#include "compiler/model/units.h"
#include "compiler/source/source.h"
#include "runtime/plan/format.h"

namespace probe::sema {

enum class TypeKind : std::uint8_t { kPoison, kBool, kReal, kVector, kBody, kJoint, kRegion };
struct Type {
  TypeKind kind = TypeKind::kPoison;
  Dimension dimension;            // kReal, kVector
  bool is_object = false;         // kBody: certainly one of the task's objects
  bool is_angle_between = false;  // the value of `angle(u, v)`: only to be compared with a constant
  bool is_part = false;           // kBody: certainly a part of a fixture
  bool is_open = false;           // a role that a part or a region may fill: each task knows
};

enum class Measure : std::uint8_t {
#define PROBE_MEASURE(id, name, params, result, length, time, angle, mass, of_start, meaning) id,
#include "compiler/model/measures.def"
};
// Whether it is counted from the first camera or the robot's base.
constexpr bool is_of_frame(Measure measure) {
  return measure == Measure::kViewX || measure == Measure::kViewY || measure == Measure::kRobotX ||
         measure == Measure::kRobotY;
}

using ExprRef = std::uint32_t;
inline constexpr ExprRef kNoExpr = 0xffffffffu;
using SetRef = std::uint32_t;

enum class ExprOp : std::uint8_t {
  kPoison,
  kConstant,  // a: index into quantities
  kRole,      // a: RoleId
  kObject,    // a: ObjectId, by its name
  kFixture,   // the scene's fixture, by its name
  kSurface,   // the surface as a body
  kPart,      // a: fixture; b: part of it
  kJoint,     // a: fixture; b: joint of it; as a value
  kRegion,    // a: fixture; b: region of it
  kRegionOf,  // args[0]: body; a: index into names
  kStanding,  // the scene's fixture without joints
  kVariable,  // a: parameter or quantifier variable of the enclosing predicate or metric
  kVector,    // args: x, y, z, constants
  kMeasure,   // measure, args
  kCall,      // predicate, args: one per parameter
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kNegate,
  kLess,
  kLessEqual,
  kEqual,  // `>` and `>=` are stored with swapped sides, `!=` as not equal
  kAnd,
  kOr,  // args, two or more
  kNot,
  kOnce,
  kAlways,
  kHold,  // args[0]; a: steps
  kAny,
  kAll,
  kNo,  // args[0]: body; a: variable; set
};

struct ExprNode {
  ExprOp op = ExprOp::kPoison;
  Measure measure{};
  Type type;
  Span span;
  std::uint32_t a = 0, b = 0;
  std::uint32_t height = 1;  // levels below and with it, through the predicates it calls
  PredicateId predicate = PredicateId::kNone;
  SetRef set = 0;
  std::vector<ExprRef> args;
};

enum class SetOp : std::uint8_t {
  kFingers,
  kLinks,
  kBodies,
  kObjects,
  kOthers,
  kDistractors,
  kAlike,  // relations: what the rest of a phrase fits
  kRole,   // role: all that fill it
  kParts,  // that a joint moves
  kNames,  // bodies: expressions
  kWhole,  // bodies: one expression, a body or a region: all bodies of that thing
  kUnion,
  kIntersection,
  kDifference
};
struct SetNode {
  SetOp op = SetOp::kBodies;
  Span span;
  std::vector<ExprRef> bodies;
  SetRef left = 0, right = 0;
  RoleId role = RoleId::kNone;
};

struct ExprArena {
  std::vector<ExprNode> nodes;
  std::vector<SetNode> sets;
  std::vector<Quantity> quantities;
  bool needs_frame = false;    // a measure of some expression is_of_frame
  bool names_objects = false;  // some expression names an object or a fixture
  std::vector<std::string> names;
};

struct Parameter {
  std::string name;
  Type type;
  ExprRef default_value = kNoExpr;
};
struct Predicate {
  std::string name;
  bool broken = false;  // something was reported: what follows from that is not said
  Span span;
  std::vector<Parameter> parameters;
  std::uint32_t variables = 0;  // parameters and quantifier variables
  ExprRef body = kNoExpr;
  Type type;
  bool is_relation = false;        // measures what is known of a start, and phrases may use it
  bool is_comparison = false;      // a relation to those alike: of one alone it does not hold
  std::uint32_t objects = 0;       // of a relation: its first parameters, which are objects
  std::vector<std::string> words;  // of a relation: what says it, in lower case
};

struct Metric {
  std::string name;
  Span span;  // of the name
  plan::Readout readout = plan::Readout::kAtEnd;
  Span readout_span;
  ExprRef expr = kNoExpr;
  std::uint32_t variables = 0;
  Type type;  // of the expression
};
struct Metrics {
  std::string name;
  bool broken = false;  // something was reported: what follows from that is not said
  MetricsId like = MetricsId::kNone;
  Span span;
  std::vector<Metric> items;
};

}  // namespace probe::sema
