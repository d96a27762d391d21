#include "runtime/mjcf/values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "runtime/base/printable.h"
#include "runtime/base/trig.h"

namespace probe::mjcf {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::size_t kLongestShown = 60;

// The next word of `text`, which is cut off; empty at the end.
std::string_view next_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::optional<double> to_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

Quat about(const Vec3& axis, double angle, bool degrees) {
  const SinCos half = degrees ? portable_sincos_deg(angle / 2) : portable_sincos(angle / 2);
  const Vec3 v = half.sin * axis;
  return {half.cos, v.x(), v.y(), v.z()};
}

}  // namespace

Values::Values(const Document& document, const Element& element,
               std::vector<const Element*> classes)
    : document_(&document), element_(&element), classes_(std::move(classes)) {}

std::optional<Values::Value> Values::own(std::string_view name) const {
  const std::string* text = element_->find(name);
  if (text == nullptr) return std::nullopt;
  return Value{*text, element_->at};
}

std::optional<Values::Value> Values::find(std::string_view name) const {
  if (const auto said = own(name)) return said;
  for (const Element* of : classes_) {
    if (const std::string* text = of->find(name)) return Value{*text, of->at};
  }
  return std::nullopt;
}

Failure Values::fail(const At& at, std::string message) const {
  return {Fault::kAsset, std::move(message), document_->where(at)};
}

Status Values::read(std::string_view name, std::span<double> to, std::size_t least,
                    std::size_t* count) const {
  const auto value = find(name);
  if (!value) return {};
  const auto wrong = [&](const std::string& wanted) {
    return fail(value->at, fmt::format("`{}` of `{}` is `{}`, expected {}", name, element_->tag,
                                       printable(value->text, kLongestShown), wanted));
  };
  std::string_view left = value->text;
  std::size_t n = 0;
  for (std::string_view word = next_word(left); !word.empty(); word = next_word(left)) {
    const auto number = to_number(word);
    if (!number) return wrong("finite numbers");
    if (n == to.size()) return wrong(fmt::format("{} number{}", n, n == 1 ? "" : "s"));
    to[n++] = *number;
  }
  if (n < least)
    return wrong(fmt::format("{}{} number{}", least == to.size() ? "" : "at least ", least,
                             least == 1 ? "" : "s"));
  if (count != nullptr) *count = n;
  return {};
}

Status Values::read(std::string_view name, double& to) const {
  return read(name, std::span<double>(&to, 1), 1);
}

Status Values::read_not_negative(std::string_view name, double& to) const {
  PROBE_TRY(read(name, to));
  if (to >= 0) return {};
  return fail(find(name)->at, fmt::format("`{}` of `{}` is below 0", name, element_->tag));
}

Status Values::read(std::string_view name, int& to) const {
  double number = to;
  PROBE_TRY(read(name, number));
  if (std::abs(number) <= 1e6 && number == std::floor(number)) {
    to = static_cast<int>(number);
    return {};
  }
  return fail(find(name)->at, fmt::format("`{}` of `{}` is no whole number of a size that is "
                                          "expected",
                                          name, element_->tag));
}

Status Values::read_word(std::string_view name, std::span<const std::string_view> words,
                         std::size_t& to) const {
  const auto value = find(name);
  if (!value) return {};
  std::string known;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (value->text == words[i]) {
      to = i;
      return {};
    }
    known += fmt::format("{}`{}`", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  }
  return fail(value->at, fmt::format("`{}` of `{}` is `{}`, expected {}", name, element_->tag,
                                     printable(value->text, kLongestShown), known));
}

Status Values::read(std::string_view name, bool& to) const {
  constexpr std::string_view kWords[] = {"false", "true"};
  std::size_t which = to ? 1 : 0;
  PROBE_TRY(read_word(name, kWords, which));
  to = which == 1;
  return {};
}

Status Values::read(std::string_view name, std::string& to) const {
  if (const auto value = find(name)) to = value->text;
  return {};
}

Status Values::read(std::string_view name, Vec3& to) const {
  return read(name, std::span<double>(to.data(), 3), 3);
}

Quat turn_of_z(const Vec3& axis) {
  const Vec3 cross = Vec3::UnitZ().cross(axis);
  const double s = cross.norm();
  if (s < 1e-10) return axis.z() < 0 ? Quat(0, 1, 0, 0) : Quat::Identity();
  // Of half the angle: tan(a / 2) = sin a / (1 + cos a), steady but for a half turn.
  if (axis.z() > -0.5) {
    const double w = 1 + axis.z();
    return Quat(w, cross.x(), cross.y(), cross.z()).normalized();
  }
  const Vec3 unit = cross / s;
  const double cot = s / (1 - axis.z());
  return Quat(cot, unit.x(), unit.y(), unit.z()).normalized();
}

Status read_rotation(const Values& values, const Compiler& compiler, Quat& to) {
  constexpr std::string_view kForms[] = {"axisangle", "euler", "xyaxes", "zaxis", "quat"};
  std::string_view form;
  At at = values.at();
  for (const std::string_view each : kForms) {
    if (!values.own(each)) continue;
    if (!form.empty()) return values.fail(fmt::format("both `{}` and `{}` are said", form, each));
    form = each;
  }
  for (const std::string_view each : kForms) {
    if (form.empty() && values.has(each)) form = each;
  }
  if (form.empty()) return {};
  at = values.find(form)->at;
  double v[6] = {};
  const std::size_t count = form == "xyaxes" ? 6 : form == "euler" || form == "zaxis" ? 3 : 4;
  PROBE_TRY(values.read(form, std::span<double>(v, count), count));
  const auto nothing = [&] {
    return values.fail(at, fmt::format("`{}` has a direction of no length", form));
  };
  constexpr double kLeast = 1e-15;
  if (form == "quat") {
    const Quat q(v[0], v[1], v[2], v[3]);
    if (!(q.norm() > kLeast)) return nothing();
    to = q.normalized();
  } else if (form == "axisangle") {
    const Vec3 axis(v[0], v[1], v[2]);
    if (!(axis.norm() > kLeast)) return nothing();
    to = about(axis.normalized(), v[3], compiler.degrees);
  } else if (form == "zaxis") {
    const Vec3 axis(v[0], v[1], v[2]);
    if (!(axis.norm() > kLeast)) return nothing();
    to = turn_of_z(axis.normalized());
  } else if (form == "xyaxes") {
    Vec3 x(v[0], v[1], v[2]), y(v[3], v[4], v[5]);
    if (!(x.norm() > kLeast)) return nothing();
    x.normalize();
    y -= x.dot(y) * x;
    if (!(y.norm() > kLeast)) return nothing();
    y.normalize();
    Mat3 m;
    m << x, y, x.cross(y);
    to = Quat(m).normalized();
  } else {
    to = Quat::Identity();
    for (std::size_t i = 0; i < 3; ++i) {
      const char c = compiler.eulerseq[i];
      const bool fixed = c < 'a';
      const Quat turn = about(Vec3::Unit(fixed ? c - 'X' : c - 'x'), v[i], compiler.degrees);
      to = fixed ? turn * to : to * turn;
    }
    to.normalize();
  }
  return {};
}

Result<Classes> Classes::read(const Document& document) {
  Classes made;
  made.classes_["main"];
  for (const Element& element : document.root.children) {
    if (element.tag == "default") PROBE_TRY(made.add(document, element, ""));
  }
  return made;
}

Status Classes::add(const Document& document, const Element& element, const std::string& parent) {
  const std::string* said = element.find("class");
  if (said == nullptr && !parent.empty())
    return Failure{Fault::kAsset, "a `default` within another has no `class`",
                   document.where(element.at)};
  // The outermost may be called as it likes; there is one of it, in as many pieces as there are.
  const std::string name = parent.empty() ? "main" : *said;
  if (!parent.empty() && has(name))
    return Failure{Fault::kAsset, "a second class `" + name + "`", document.where(element.at)};
  constexpr std::size_t kMostClasses = 1024;
  if (classes_.size() > kMostClasses)
    return Failure{Fault::kAsset, fmt::format("more than {} classes", kMostClasses),
                   document.where(element.at)};
  if (parent.empty() && said != nullptr && *said != "main") classes_[*said].parent = "main";
  classes_[name].parent = parent;
  for (const Element& child : element.children) {
    if (child.tag == "default") {
      PROBE_TRY(add(document, child, name));
    } else {
      classes_[name].elements.push_back(&child);
    }
  }
  return {};
}

std::vector<const Element*> Classes::of(std::string_view name, std::string_view tag) const {
  std::vector<const Element*> found;
  for (auto at = classes_.find(name); at != classes_.end(); at = classes_.find(at->second.parent)) {
    const auto& elements = at->second.elements;
    for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
      if ((*e)->tag == tag) found.push_back(*e);
    }
    if (at->second.parent.empty()) break;
  }
  return found;
}

}  // namespace probe::mjcf
