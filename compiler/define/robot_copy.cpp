#include "compiler/define/robot_copy.h"

#include <algorithm>

namespace probe::sema {

RobotText over(const RobotText& copied, const syntax::RobotDecl& own) {
  RobotText out = copied;
  const std::size_t inherited = out.drives.size();
  std::vector<bool> replaced(inherited, false);
  std::size_t copied_left = out.statements.size();
  for (const syntax::RobotStmt& stmt : own.body) {
    const auto* drive = std::get_if<syntax::DriveStmt>(&stmt);
    if (drive == nullptr) {
      const auto end = out.statements.begin() + static_cast<std::ptrdiff_t>(copied_left);
      const auto same =
          std::find_if(out.statements.begin(), end, [&](const syntax::RobotStmt* known) {
            return known->index() == stmt.index();
          });
      if (same != end) {
        out.statements.erase(same);
        --copied_left;
      }
      out.statements.push_back(&stmt);
      continue;
    }
    for (const syntax::Name& joint : drive->joints) {
      std::size_t place = 0;
      while (place < inherited &&
             (replaced[place] || out.drives[place].joint->text != joint.text))
        ++place;
      if (place == inherited) {
        out.drives.push_back({drive, &joint});
      } else {
        out.drives[place] = {drive, &joint};
        replaced[place] = true;
      }
    }
  }
  // A hand that was copied goes with its fingers.
  const auto is_own = [&](const syntax::RobotStmt* stmt) {
    return stmt >= own.body.data() && stmt < own.body.data() + own.body.size();
  };
  const bool is_bare = std::ranges::any_of(own.body, [](const syntax::RobotStmt& stmt) {
    const auto* fingers = std::get_if<syntax::FingersStmt>(&stmt);
    return fingers != nullptr && fingers->fingers.empty();
  });
  if (is_bare) {
    std::erase_if(out.statements, [&](const syntax::RobotStmt* stmt) {
      return std::holds_alternative<syntax::GripStmt>(*stmt) && !is_own(stmt);
    });
  }
  return out;
}

}  // namespace probe::sema
