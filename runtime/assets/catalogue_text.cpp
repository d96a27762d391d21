#include "runtime/assets/catalogue_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace probe::assets {
namespace {

std::string identifier(const std::string& folder) {
  std::string name = folder;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return std::isalnum(c) != 0 ? static_cast<char>(std::tolower(c)) : '_';
  });
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 ? "model_" + name
                                                                                : name;
}

std::string words(const std::string& folder) {
  std::string text = folder;
  std::replace(text.begin(), text.end(), '_', ' ');
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
  for (const CatalogueObject& object : objects) {
    out += fmt::format(
        "\nobject {} {{\n  mesh \"{}\"; box {}; density {:g}kg/m3; friction 0.5\n  name "
        "\"{}\"\n}}\n",
        identifier(object.folder), object.folder, box(object.min, object.max), object.density,
        words(object.folder));
  }
  return out;
}

}  // namespace probe::assets
