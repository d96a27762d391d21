// What the statements of a robot are that copies another.
#pragma once

#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// One joint of one `drive`.
struct DrivenJoint {
  const syntax::DriveStmt* stmt = nullptr;
  const syntax::Name* joint = nullptr;
};

// The statements of one robot as they hold: those of `like` before its own.
struct RobotText {
  std::vector<const syntax::RobotStmt*> statements;  // all but `drive`; each word once
  std::vector<DrivenJoint> drives;                   // in the order of the joints
};

// `own` over `copied`: a statement takes the place of the one with its word, a driven joint the
// place of the same joint, so a copy keeps the order of the joints.
RobotText over(const RobotText& copied, const syntax::RobotDecl& own);

}  // namespace probe::sema
