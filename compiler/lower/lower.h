// Metrics of one task to a program: predicates inlined, quantifiers unrolled over the task's
// bodies, units gone.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/geometry/frame.h"
#include "compiler/lower/intervals.h"
#include "compiler/lower/program.h"
#include "compiler/model/model.h"

namespace probe::lower {

// The task-local bodies in the plan's order (format.h, BodyRecord).
struct Body {
  plan::BodyKind kind = plan::BodyKind::kObject;
  // kObject: sema::ObjectId; kLink: 0, 1 fingers, then on; kPart: sema::FixtureId
  std::uint32_t index = 0;
  std::string name;
  // Of an object: its sema::RoleId, kDistractor, or kNone for what the layout placed; of a part the
  // role that it fills, or kNone.
  std::uint32_t role = 0xffffffffu;
  std::uint32_t part = 0;  // kPart: of its fixture's
  // Its boxes with names, and, where it has some, 1 + the index of the object or scene that says
  // so.
  const std::vector<sema::Region>* regions = nullptr;
  std::uint32_t owner = 0;
  // Of its regions those that fill roles: with the role and the region's number in its fixture.
  struct Filled {
    std::uint32_t role = 0, number = 0;
    const sema::Region* region = nullptr;
    std::string name;
  };
  std::vector<Filled> filled = {};
  bool is_finger = false;  // of a link
};
inline constexpr std::uint32_t kDistractorRole = 0xfffffffeu;

// The robot of the task's scene must have its model.
std::vector<Body> bodies_of(const sema::Model& model, const sema::Task& task);

// All that lower_metrics looks at: metrics of one shape have one program, whatever the objects are.
std::vector<std::uint32_t> shape_of(const sema::Model& model, std::span<const sema::Metric> metrics,
                                    const std::vector<Body>& bodies);

// What the task's scene, layout and objects leave room for.
Room room_of(const sema::Model& model, const sema::Task& task);

// In: typed metrics of a task, its bodies, and what they are placed in. Out: their program, metric
// after metric in their order, equal parts computed once; nothing when one cannot be measured,
// which has been reported.
std::optional<Program> lower_metrics(const sema::Model& model,
                                     std::span<const sema::Metric> metrics,
                                     const std::vector<Body>& bodies, const sema::Frame& frame,
                                     Diagnostics& diagnostics);

// The same of one relation of the bodies `of`, its objects; `alike` are the bodies of that set,
// ascending. Its one metric says whether it holds.
std::optional<Program> lower_relation(const sema::Model& model, const sema::Predicate& relation,
                                      std::span<const std::uint16_t> of,
                                      const std::vector<std::uint16_t>& alike,
                                      const std::vector<Body>& bodies, const sema::Frame& frame,
                                      Diagnostics& diagnostics);

// A body that words may denote: all of its relations must hold.
struct ClaimedBody {
  std::uint16_t body = 0;
  // The one that the words mean. A relation to those alike is asked of each list of them: of this
  // body it must hold of all lists, any other may be denoted where it holds of one.
  bool is_meant = false;
  struct Relation {
    const sema::Predicate* relation = nullptr;
    std::vector<std::uint16_t> of;                  // its objects, `body` first
    std::vector<std::vector<std::uint16_t>> alike;  // one list, or those for certain and all
  };
  std::vector<Relation> relations;
};

// An object that a layout puts on another or into a region of a part.
struct PutBody {
  std::uint16_t body = 0, carrier = 0;
  const sema::Region* region = nullptr;
  bool in = false;  // else on
};

// Whether it lies there, as the program of a claim.
std::optional<Program> lower_put(const sema::Model& model, const PutBody& put, const Span& span,
                                 const std::vector<Body>& bodies, const sema::Frame& frame,
                                 Diagnostics& diagnostics);

// The program of a claim: a truth for each of the bodies, called as plan::claim_metric says.
std::optional<Program> lower_claim(const sema::Model& model, std::span<const ClaimedBody> claimed,
                                   const std::vector<Body>& bodies, const sema::Frame& frame,
                                   Diagnostics& diagnostics);

}  // namespace probe::lower
