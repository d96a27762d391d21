// The control law of a robot: its numbers as `control` says them, and what its drives have to say
// under it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/model/model.h"
#include "compiler/names/context.h"

namespace probe::sema {

// What was written of a drive.
struct WrittenDrive {
  Span span;
  Spelled joint;
  std::optional<Quantity> stiffness, damping, limit, friction, armature;
  // Whether the joint slides, as the units say; nothing without any.
  std::optional<bool> slides() const;
};

// Whether the robot's law gives efforts, not targets.
bool by_efforts(const Robot& robot);

// Robot::law of the kind that is written, without its numbers: what other statements mean depends
// on it.
void choose_law(const syntax::ControlStmt& stmt, Robot& robot);

// Its numbers, but for `home`, which needs the description. After choose_law().
void read_control(Context& context, const syntax::ControlStmt& stmt, Robot& robot);

// The gripper's own numbers: only laws that give efforts read them.
void read_sign_grip(Context& context, const syntax::GripStmt& stmt, Robot& robot);

// Fills Robot::drives: what the law wants of each, and where the description has it instead. After
// the description was read, if it could be. What a law lacks is said only where it is known.
void define_drives(Context& context, std::span<const WrittenDrive> written, bool is_law_known,
                   Robot& robot);

// One position for each joint of the arm, in the order of the drives. After define_drives().
void define_home(Context& context, const syntax::ControlStmt& stmt, Robot& robot);

}  // namespace probe::sema
