#include "runtime/mjcf/obj_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace probe::mjcf {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view name, std::size_t most)
      : text_(text), name_(name), most_(most) {}

  Result<scene::Mesh> run() {
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      line_ = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++number_;
      PROBE_TRY(read_line());
    }
    if (part_.indices.empty()) return wrong("has no face");
    if (!all_normals_) part_.normals.clear();
    if (!all_texels_) part_.uv.clear();
    scene::Mesh mesh;
    mesh.name = std::string(name_);
    mesh.materials.resize(1);
    mesh.parts.push_back(std::move(part_));
    return mesh;
  }

 private:
  using Corner = std::array<long, 3>;  // of a place, a texel, a normal, from 0; -1: none

  Failure wrong(const std::string& message) const {
    return {Fault::kAsset, message, std::string(name_) + ":" + std::to_string(number_)};
  }

  std::string_view word() {
    const std::size_t begin = std::min(line_.find_first_not_of(" \t\r"), line_.size());
    line_.remove_prefix(begin);
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t\r"));
    line_.remove_prefix(found.size());
    return found;
  }

  template <std::size_t N>
  Status read_numbers(std::vector<std::array<float, N>>& to) {
    std::array<float, N>& values = to.emplace_back();
    for (float& value : values) {
      const std::string_view said = word();
      const auto [at, error] = std::from_chars(said.data(), said.data() + said.size(), value);
      if (error != std::errc() || at != said.data() + said.size() || !std::isfinite(value))
        return wrong("expected a number, found `" + std::string(said) + "`");
    }
    return {};
  }

  Status read_line() {
    const std::string_view what = word();
    if (what == "v") return read_numbers(places_);
    if (what == "vt") return read_numbers(texels_);
    if (what == "vn") return read_numbers(normals_);
    if (what == "f") return read_face();
    return {};  // groups, materials, comments
  }

  Status read_face() {
    std::vector<std::uint32_t> corners;
    for (std::string_view said = word(); !said.empty(); said = word()) {
      PROBE_ASSIGN(const Corner corner, read_corner(said));
      corners.push_back(index_of(corner));
    }
    if (corners.size() < 3) return wrong("a face has three corners or more");
    for (std::size_t i = 2; i < corners.size(); ++i)
      part_.indices.insert(part_.indices.end(), {corners[0], corners[i - 1], corners[i]});
    if (part_.indices.size() / 3 > most_) return wrong("has too many faces");
    return {};
  }

  // `1`, `1/2`, `1//3` or `1/2/3`; below 0: counted from the last one.
  Result<Corner> read_corner(std::string_view said) const {
    const std::array<std::size_t, 3> there{places_.size(), texels_.size(), normals_.size()};
    Corner corner{-1, -1, -1};
    std::string_view left = said;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view one = left.substr(0, left.find('/'));
      left.remove_prefix(std::min(one.size() + 1, left.size()));
      if (one.empty()) {
        if (k == 0) return wrong("expected a corner, found `" + std::string(said) + "`");
        continue;
      }
      long index = 0;
      const auto [at, error] = std::from_chars(one.data(), one.data() + one.size(), index);
      const auto count = static_cast<long>(there[k]);
      const long from_first = index < 0 ? count + index : index - 1;
      if (error != std::errc() || at != one.data() + one.size() || from_first < 0 ||
          from_first >= count)
        return wrong("a face names what is not there: `" + std::string(said) + "`");
      corner[k] = from_first;
    }
    if (!left.empty()) return wrong("expected a corner, found `" + std::string(said) + "`");
    return corner;
  }

  std::uint32_t index_of(const Corner& corner) {
    const auto [known, is_new] =
        known_.try_emplace(corner, static_cast<std::uint32_t>(known_.size()));
    if (!is_new) return known->second;
    const auto& place = places_[static_cast<std::size_t>(corner[0])];
    part_.positions.insert(part_.positions.end(), place.begin(), place.end());
    std::array<float, 2> texel{};
    if (corner[1] >= 0) {
      const auto& from = texels_[static_cast<std::size_t>(corner[1])];
      texel = {from[0], 1 - from[1]};
    }
    std::array<float, 3> normal{};
    if (corner[2] >= 0) normal = normals_[static_cast<std::size_t>(corner[2])];
    part_.uv.insert(part_.uv.end(), texel.begin(), texel.end());
    part_.normals.insert(part_.normals.end(), normal.begin(), normal.end());
    all_texels_ = all_texels_ && corner[1] >= 0;
    all_normals_ = all_normals_ && corner[2] >= 0;
    return known->second;
  }

  std::string_view text_, line_, name_;
  std::size_t most_, number_ = 0;
  std::vector<std::array<float, 3>> places_, normals_;
  std::vector<std::array<float, 2>> texels_;
  std::map<Corner, std::uint32_t> known_;
  scene::MeshPart part_;
  bool all_normals_ = true, all_texels_ = true;
};

}  // namespace

Result<scene::Mesh> read_obj(std::string_view text, std::string_view name, std::size_t most_faces) {
  return ObjReader(text, name, most_faces).run();
}

}  // namespace probe::mjcf
