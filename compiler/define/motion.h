// `moves`: ways that objects take by themselves. Which objects a name stands for depends on the
// task, since tasks inherit ways.
#pragma once

#include <optional>
#include <vector>

#include "compiler/names/context.h"
#include "runtime/plan/format.h"

namespace probe::sema {

// As written, `none` without legs; nothing when a mistake was reported. `speed` is the number that
// is said or bound.
std::optional<Motion> read_motion(Context& context, const syntax::MovesStmt& stmt,
                                  const syntax::Quantity& speed);

// Each name stands for objects of the task that stand for themselves; false when a mistake was
// reported.
bool check_motions(Context& context, const Task& task);

// Who moves how, in the order of the task's objects.
struct Mover {
  std::size_t place = 0;  // of Task::objects()
  ObjectId object = ObjectId::kNone;
  const Motion* motion = nullptr;
};
std::vector<Mover> movers_of(const Model& model, const Task& task);

// The legs of a way, as a plan has them.
std::vector<plan::MoveRecord> legs_of(const Motion& motion, std::size_t body);

bool same_motions(const Model& model, const Task& a, const Task& b);

}  // namespace probe::sema
