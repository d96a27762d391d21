#include "compiler/define/described.h"

#include <filesystem>
#include <utility>

namespace probe::sema {

std::optional<robot::RobotModel> described_by(Context& context, const Spelled& urdf,
                                              const std::string& what) {
  auto model = robot::load_urdf((std::filesystem::path(context.asset_root) / urdf.text).string());
  if (model.ok()) return std::move(model).value();
  context
      .report(Situation::kUrdfUnreadable, urdf.span,
              what + " cannot be read: " + model.failure().message)
      .note("looked for `" + urdf.text + "` in the assets folder");
  return std::nullopt;
}

}  // namespace probe::sema
