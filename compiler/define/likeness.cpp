#include "compiler/define/likeness.h"

#include <algorithm>
#include <cmath>

#include "compiler/define/paint.h"

namespace probe::sema {
namespace {

constexpr double kSameSize = 0.1;  // of the larger extent: less is not seen without the other

bool are_one_size(const Object& a, const Object& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double one = a.box_max[i] - a.box_min[i], other = b.box_max[i] - b.box_min[i];
    if (std::abs(one - other) > kSameSize * std::max(one, other)) return false;
  }
  return true;
}

// What is said of an attribute: the same of both, something else, or nothing of one of them.
Truth agree(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  if (a.empty() || b.empty()) return Truth::kUnknown;
  const bool share = std::ranges::any_of(
      a, [&](std::uint32_t value) { return std::ranges::find(b, value) != b.end(); });
  return share ? Truth::kYes : Truth::kNo;
}

bool is_bare(const Object& object) { return !object.paint && !object.texture; }

// A mesh may stand in for things of other colours in texts that are about something else.
bool is_nothing_said_to_differ(const Object& a, const Object& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (agree(a.values[i], b.values[i]) == Truth::kNo) return false;
  }
  return true;
}

// One word for the colours of both.
bool have_one_color(const Model& model, const Object& a, const Object& b) {
  const auto color = color_attribute(model);
  if (!color) return false;
  const auto at = static_cast<std::size_t>(*color);
  return agree(a.values[at], b.values[at]) == Truth::kYes;
}

// Of two of one mesh. Of what is painted, and of paint beside a mesh's own colours, the text says
// what colour that is.
bool have_one_look(const Model& model, const Object& a, const Object& b) {
  if (a.texture || b.texture) return a.texture && b.texture && a.texture->is_same(*b.texture);
  if (is_bare(a) && is_bare(b)) return is_nothing_said_to_differ(a, b);
  return (a.paint && b.paint && are_alike(*a.paint, *b.paint)) || have_one_color(model, a, b);
}

bool is_said_alike(const Object& a, const Object& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (agree(a.values[i], b.values[i]) != Truth::kYes) return false;
  }
  return !a.values.empty();
}

}  // namespace

bool look_alike(const Model& model, ObjectId a_id, ObjectId b_id) {
  const Object& a = model.objects[a_id];
  const Object& b = model.objects[b_id];
  if (a.of || b.of || a.broken || b.broken || !are_one_size(a, b)) return false;
  if (a.mesh.text == b.mesh.text) return have_one_look(model, a, b);
  // Two pictures on two shapes are looked at by nobody here.
  if (a.texture || b.texture) return false;
  return (a.paint || b.paint) && is_said_alike(a, b);
}

}  // namespace probe::sema
