#include "compiler/define/described.h"

#include <utility>

#include "compiler/define/remembered.h"

namespace probe::sema {

std::optional<robot::RobotModel> described_by(Context& context, const Spelled& urdf,
                                              const std::string& what) {
  const std::string path = context.asset_root.file(urdf.text);
  Remembered* const remembered = context.reporter.depth.remembered;
  if (const auto* known = remembered ? remembered->described(path) : nullptr) return *known;
  const Remembered::Key stamp = remembered ? Remembered::stamp_of(path) : Remembered::Key{};
  auto model = robot::load_urdf(path);
  if (model.ok()) {
    if (remembered != nullptr) remembered->keep_described(path, stamp, *model);
    return std::move(model).value();
  }
  const Failure& failure = model.failure();
  // `where` is the path, or the path and a line of it.
  const bool has_line = failure.where.starts_with(path + ":");
  Diagnostic& said =
      context
          .report(Situation::kUrdfUnreadable, urdf.span,
                  what + " cannot be read: " + failure.message)
          .note(has_line ? "line " + failure.where.substr(path.size() + 1) + " of `" + path + "`"
                         : "looked for `" + urdf.text + "` in the assets folder");
  const std::string advice = context.asset_root.advice(urdf.text);
  if (!advice.empty()) said.help(advice);
  return std::nullopt;
}

}  // namespace probe::sema
