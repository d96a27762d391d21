#include "compiler/language/moved.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace probe::language {
namespace {

Failure cannot(const std::string& why) { return {Fault::kUsage, why, ""}; }

// Whether a word of `place` means the object in the task.
bool means(const sema::Model& model, const sema::Task& task, std::string_view word,
           sema::ObjectId object) {
  const sema::RoleId role = task.role_of(object);
  if (role != sema::RoleId::kNone && word == model.roles[role].name) return true;
  if (word == "distractors") return std::ranges::find(task.distractors, object) != task.distractors.end();
  return word == model.objects[object].name;
}

std::optional<sema::ObjectId> find_object(const sema::Model& model, const sema::Task& task,
                                          std::string_view name) {
  for (const sema::ObjectId id : task.objects()) {
    if (model.objects[id].name == name) return id;
  }
  return std::nullopt;
}

// The statement of a layout at a place, and its point.
const syntax::Point* point_at(const Snapshot& snapshot, const Span& span) {
  const syntax::ParseResult* tree = span.is_none() ? nullptr : snapshot.tree(span.file);
  if (tree == nullptr) return nullptr;
  for (const syntax::Decl& decl : tree->file.decls) {
    const auto* layout = std::get_if<syntax::LayoutDecl>(&decl.node);
    if (layout == nullptr) continue;
    for (const syntax::LayoutStmt& stmt : layout->body) {
      if (const auto* place = std::get_if<syntax::PlaceAtStmt>(&stmt)) {
        if (place->span == span) return &place->at;
      }
      if (const auto* cells = std::get_if<syntax::CellsStmt>(&stmt)) {
        if (cells->span == span) return &cells->at;
      }
    }
  }
  return nullptr;
}

struct Length {
  double per_metre = 1;
  int most_digits = 3;  // behind the point, for whole millimetres
};
std::optional<Length> length_of(syntax::Unit unit) {
  switch (unit) {
    case syntax::Unit::kMetre:
      return Length{1, 3};
    case syntax::Unit::kCentimetre:
      return Length{100, 1};
    case syntax::Unit::kMillimetre:
      return Length{1000, 0};
    default:
      return std::nullopt;
  }
}

// "-12.5cm"; no zeros behind the last digit that counts.
std::string written(double metres, syntax::Unit unit, const Length& length) {
  const double millimetres = std::nearbyint(metres * 1000) + 0.0;
  std::string digits =
      fmt::format("{:.{}f}", millimetres / 1000 * length.per_metre + 0.0, length.most_digits);
  if (digits.find('.') != digits.npos) {
    while (digits.ends_with('0')) digits.pop_back();
    if (digits.ends_with('.')) digits.pop_back();
  }
  if (digits == "-0") digits = "0";
  return digits + std::string(syntax::to_text(unit));
}

}  // namespace

Result<std::vector<Replacement>> moved(const Snapshot& snapshot, std::string_view task_name,
                                       std::string_view object_name, const Move& move) {
  const sema::Model& model = snapshot.model();
  const sema::Task* task = snapshot.task(task_name);
  const std::string name(object_name);
  if (task == nullptr || task->layout == sema::LayoutId::kNone)
    return cannot("there is no task `" + std::string(task_name) + "` with a layout in the text");
  const auto object = find_object(model, *task, object_name);
  if (!object) return cannot("`" + name + "` is no object of `" + task->name + "`");
  for (const double end : {move.from[0], move.from[1], move.to[0], move.to[1]}) {
    if (!std::isfinite(end) || std::abs(end) > 1e3) return cannot("moved to what is no place");
  }
  const sema::Layout& layout = model.layouts[task->layout];
  if (!layout.given_span.is_none())
    return cannot("where `" + name + "` stands is a row of the table of layout `" + layout.name +
                  "`");
  const auto place = std::ranges::find_if(layout.places, [&](const sema::Place& one) {
    return std::ranges::any_of(one.what, [&](const sema::Spelled& word) {
      return means(model, *task, word.text, *object);
    });
  });
  if (place == layout.places.end())
    return cannot("layout `" + layout.name + "` does not say where `" + name + "` stands");
  if (place->is_put())
    return cannot("`" + name + "` is put " +
                  (place->how == sema::Place::kOn ? std::string("on `") : std::string("in `")) +
                  place->where.text + "`: move that");
  Span span = place->span;
  if (place->how != sema::Place::kAt) {
    const auto cells = std::ranges::find(layout.cells, place->cells, &sema::Cells::name);
    if (cells == layout.cells.end()) return cannot("there are no cells `" + place->cells + "`");
    span = cells->span;
  }
  const syntax::Point* point = point_at(snapshot, span);
  if (point == nullptr || point->coordinates.size() != 2)
    return cannot("the place of `" + name + "` is written by a `derive`");
  std::vector<Replacement> out;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double by = move.to[axis] - move.from[axis];
    if (std::abs(by) < 0.0005) continue;
    const syntax::Quantity& old = point->coordinates[axis];
    // `0` needs no unit; it gets one.
    const bool is_bare = old.unit == syntax::Unit::kNone;
    const syntax::Unit unit = is_bare ? syntax::Unit::kCentimetre : old.unit;
    const auto length = length_of(unit);
    if (!length || !old.binder.empty())
      return cannot("the place of `" + name + "` is written by a `derive`");
    const double was = std::strtod(std::string(old.digits).c_str(), nullptr) *
                       (old.negative ? -1 : 1) / length->per_metre;
    const bool is_own = place->how == sema::Place::kAt && layout.jitter == 0;
    out.push_back({old.span, written(is_own ? move.to[axis] : was + by, unit, *length)});
  }
  return out;
}

}  // namespace probe::language
