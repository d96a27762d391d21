#include "runtime/assets/catalogue_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "runtime/assets/identifier.h"
#include "runtime/base/printable.h"

namespace probe::assets {
namespace {

constexpr std::size_t kLongestFolder = 200;  // bytes; a name has at most 255

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether a text can say the folder and has something to call the object by.
bool is_plain(const std::string& folder) {
  constexpr std::string_view kMarks = " _-+.,()'";
  const auto is_known = [&](char c) {
    return is_letter(c) || is_digit(c) || kMarks.find(c) != kMarks.npos;
  };
  return folder.size() <= kLongestFolder && std::ranges::all_of(folder, is_known) &&
         std::ranges::any_of(folder, [](char c) { return is_letter(c) || is_digit(c); });
}

std::string identifier(const std::string& folder, std::set<std::string>& taken) {
  std::string name = identifier_of(folder, "model");
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  std::string free = name;
  for (int i = 2; !taken.insert(free).second; ++i) free = name + "_" + std::to_string(i);
  return free;
}

// What a plan can hold.
bool has_size(const CatalogueObject& object) {
  const Vec3 size = object.max - object.min;
  return size.allFinite() && (size.array() >= 1e-6).all() &&
         object.min.cwiseAbs().maxCoeff() <= 1000 && object.max.cwiseAbs().maxCoeff() <= 1000 &&
         object.density >= 1e-3 && object.density <= 1e6;
}

std::string words(const std::string& folder) {
  std::string text = folder;
  std::replace(text.begin(), text.end(), '_', ' ');
  text.erase(0, text.find_first_not_of(' '));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string cm(double metres) { return fmt::format("{:.6g}cm", 100 * metres + 0.0); }

std::string box(const Vec3& min, const Vec3& max) {
  const Vec3 size = max - min;
  if ((min + max).cwiseAbs().maxCoeff() < 1e-9) {
    return fmt::format("{} x {} x {}", cm(size.x()), cm(size.y()), cm(size.z()));
  }
  return fmt::format("({}, {}, {}) .. ({}, {}, {})", cm(min.x()), cm(min.y()), cm(min.z()),
                     cm(max.x()), cm(max.y()), cm(max.z()));
}

}  // namespace

std::string catalogue_text(const std::vector<CatalogueObject>& objects) {
  std::string out =
      "# The models of this folder as objects: box and density are the database's. The suite's "
      "own\n"
      "# catalogue says more of those it uses; copy the ones you want to talk about.\n";
  std::set<std::string> taken;
  for (const CatalogueObject& object : objects) {
    if (!is_plain(object.folder) || !has_size(object)) {
      out += "\n# left out, for its " +
             std::string(is_plain(object.folder) ? "box or density" : "name") + ": " +
             printable(object.folder, kLongestFolder) + "\n";
      continue;
    }
    out += fmt::format(
        "\nobject {} {{\n  mesh \"{}\"; box {}; density {:g}kg/m3; friction 0.5\n  name "
        "\"{}\"\n}}\n",
        identifier(object.folder, taken), object.folder, box(object.min, object.max),
        object.density, words(object.folder));
  }
  return out;
}

}  // namespace probe::assets
