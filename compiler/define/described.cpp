#include "compiler/define/described.h"

#include <utility>

namespace probe::sema {

std::optional<robot::RobotModel> described_by(Context& context, const Spelled& urdf,
                                              const std::string& what) {
  auto model = robot::load_urdf(context.asset_root.file(urdf.text));
  if (model.ok()) return std::move(model).value();
  Diagnostic& said = context
                         .report(Situation::kUrdfUnreadable, urdf.span,
                                 what + " cannot be read: " + model.failure().message)
                         .note("looked for `" + urdf.text + "` in the assets folder");
  const std::string advice = context.asset_root.advice(urdf.text);
  if (!advice.empty()) said.help(advice);
  return std::nullopt;
}

}  // namespace probe::sema
