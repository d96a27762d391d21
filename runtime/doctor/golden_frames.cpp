#include "runtime/doctor/golden_frames.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/own_folder.h"
#include "runtime/scene/image.h"

namespace probe::doctor {
namespace {

namespace fs = std::filesystem;

constexpr double kDepthUnit = 1e-6;        // m
constexpr double kDepthTolerance = 1e-5;   // m
constexpr double kSettleTolerance = 1e-4;  // m

std::size_t pixels_of(const GoldenFrame& frame) {
  return static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
}

std::string file_of(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / (name + ".png")).string();
}

Sha256 hash_of(const GoldenFrame& frame) {
  Hasher hasher;
  hasher.u32(static_cast<std::uint32_t>(frame.width));
  hasher.u32(static_cast<std::uint32_t>(frame.height));
  hasher.bytes(std::as_bytes(std::span(frame.rgb)));
  hasher.bytes(std::as_bytes(std::span(frame.depth)));
  hasher.bytes(std::as_bytes(std::span(frame.ids)));
  return hasher.finish();
}

// Depth as micrometres and ids, three bytes each, most significant first.
std::vector<std::uint8_t> stacked(const GoldenFrame& frame) {
  std::vector<std::uint8_t> rows = frame.rgb;
  const auto add = [&rows](std::uint32_t value) {
    rows.push_back(static_cast<std::uint8_t>(value >> 16 & 255));
    rows.push_back(static_cast<std::uint8_t>(value >> 8 & 255));
    rows.push_back(static_cast<std::uint8_t>(value & 255));
  };
  for (const float depth : frame.depth) {
    add(static_cast<std::uint32_t>(static_cast<double>(depth) / kDepthUnit + 0.5));
  }
  for (const std::uint16_t id : frame.ids) add(id);
  return rows;
}

Result<GoldenFrame> load_golden(const std::string& folder, const std::string& name) {
  const std::string path = file_of(folder, name);
  PROBE_ASSIGN(const scene::Texture image, scene::load_image(path));
  if (image.height % 3 != 0) {
    return Failure{Fault::kAsset, "is no golden picture: its height is not three times one", path};
  }
  GoldenFrame frame;
  frame.name = name;
  frame.width = image.width;
  frame.height = image.height / 3;
  const std::size_t pixels = pixels_of(frame);
  const auto texel = [&image](std::size_t pixel, std::size_t k) {
    return image.rgba[4 * pixel + k];
  };
  const auto number = [&texel](std::size_t pixel) {
    return static_cast<std::uint32_t>(texel(pixel, 0) << 16 | texel(pixel, 1) << 8 |
                                      texel(pixel, 2));
  };
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) frame.rgb.push_back(texel(i, k));
    frame.depth.push_back(static_cast<float>(number(pixels + i) * kDepthUnit));
    frame.ids.push_back(static_cast<std::uint16_t>(number(2 * pixels + i)));
  }
  return frame;
}

// Fills the counts; true when they are within the tolerance: as many pixels as 60 of 640 x 480.
bool compare(const GoldenFrame& golden, const GoldenFrame& here, GoldenCheck& check) {
  if (golden.width != here.width || golden.height != here.height) {
    check.ids = check.levels = static_cast<int>(pixels_of(here));
    return false;
  }
  for (std::size_t i = 0; i < pixels_of(here); ++i) {
    int level = 0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      level = std::max(level, std::abs(golden.rgb[k] - here.rgb[k]));
    }
    check.levels += level > 2;
    if (golden.ids[i] != here.ids[i]) {
      ++check.ids;
      continue;
    }
    check.depth = std::max(check.depth, std::abs(static_cast<double>(golden.depth[i]) -
                                                 static_cast<double>(here.depth[i])));
  }
  const double area = static_cast<double>(pixels_of(here)) / (640.0 * 480.0);
  const int few = std::max(4, static_cast<int>(60 * area));
  return check.ids <= few && check.levels <= few && check.depth <= kDepthTolerance + kDepthUnit;
}

}  // namespace

std::string golden_folder() {
  for (const fs::path& folder : own_places("tests/golden_frames")) {
    if (fs::is_directory(folder)) return folder.string();
  }
  return {};
}

bool shown_in_golden(const std::string& folder) {
  const auto here = read_file((fs::path(folder) / "manifest.json").string());
  return here && std::ranges::any_of(own_places("assets"), [&](const fs::path& place) {
           const auto own = read_file((place / "manifest.json").string());
           return own && *here == *own;
         });
}

std::vector<std::string> golden_suites() {
  for (const fs::path& suite : own_places("suite")) {
    std::vector<std::string> texts;
    for (const char* name : {"panda.probe", "intact.probe"}) {
      if (fs::is_regular_file(suite / name)) texts.push_back((suite / name).string());
    }
    if (texts.size() == 2) return texts;
  }
  return {};
}

const char* to_text(GoldenState state) {
  switch (state) {
    case GoldenState::kIdentical:
      return "identical";
    case GoldenState::kClose:
      return "within tolerance";
    case GoldenState::kDiffers:
      return "differs";
    case GoldenState::kMissing:
      break;
  }
  return "not stored";
}

bool GoldenReport::fine() const {
  const auto good = [](GoldenState state) {
    return state == GoldenState::kIdentical || state == GoldenState::kClose;
  };
  return good(settle) &&
         std::all_of(frames.begin(), frames.end(), [&](const auto& f) { return good(f.state); });
}

store::Fingerprint picture_fingerprint() {
  store::Fingerprint all = store::take_fingerprint(Sha256{});
  // Neither of the program's own nor of what draws and settles nothing.
  std::erase_if(all.entries, [](const auto& entry) {
    constexpr std::string_view kOthers[] = {"program", "assets", "cholmod", "nlopt"};
    return std::ranges::find(kOthers, entry.first) != std::end(kOthers);
  });
  return all;
}

Status write_golden(const std::string& folder, std::span<const GoldenFrame> frames,
                    const GoldenSettle& settle) {
  std::error_code error;
  fs::create_directories(folder, error);
  Json json;
  json["fingerprint"] = Json::parse(store::to_json(picture_fingerprint()));
  for (const GoldenFrame& frame : frames) {
    PROBE_TRY(scene::write_png(file_of(folder, frame.name), frame.width, 3 * frame.height,
                               stacked(frame)));
    json["frames"][frame.name] = to_hex(hash_of(frame));
  }
  json["settle"]["state"] = to_hex(settle.state);
  for (const Vec3& p : settle.positions) {
    json["settle"]["positions_m"].push_back({p.x(), p.y(), p.z()});
  }
  const std::string text = json.sorted().dump(2) + "\n";
  return write_file((fs::path(folder) / "golden.json").string(), std::as_bytes(std::span(text)));
}

Result<GoldenReport> check_golden(const std::string& folder, std::span<const GoldenFrame> frames,
                                  const GoldenSettle& settle) {
  const std::string index = (fs::path(folder) / "golden.json").string();
  PROBE_ASSIGN(const std::string text, read_file(index));
  const auto json = Json::parse(text);
  if (!json.is_object() || !json.contains("fingerprint") || !json.contains("frames")) {
    return Failure{Fault::kAsset, "is not the index of golden pictures", index};
  }
  PROBE_ASSIGN(const store::Fingerprint stored,
               store::fingerprint_from_json(json["fingerprint"].dump()));
  GoldenReport report;
  report.other_build = store::differences(stored, picture_fingerprint());
  const GoldenState close =
      report.other_build.empty() ? GoldenState::kDiffers : GoldenState::kClose;
  for (const GoldenFrame& frame : frames) {
    GoldenCheck check;
    check.name = frame.name;
    if (const Json* hash = json["frames"].find(frame.name); hash != nullptr) {
      const auto golden = load_golden(folder, frame.name);
      if (golden) {
        const bool within = compare(*golden, frame, check);
        const bool same = hash->is_string() && *hash == to_hex(hash_of(frame));
        check.state = same ? GoldenState::kIdentical : within ? close : GoldenState::kDiffers;
      }
    }
    report.frames.push_back(std::move(check));
  }
  const auto at = json.value("settle", Json::object());
  const auto places =
      at.value("positions_m", Json::array()).get<std::vector<std::vector<double>>>();
  if (places.size() != settle.positions.size()) return report;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].size() != 3) return report;
    const Vec3 p(places[i][0], places[i][1], places[i][2]);
    report.settle_distance = std::max(report.settle_distance, (p - settle.positions[i]).norm());
  }
  // Physics is still being tuned more often than pictures: near is near on the same build too.
  report.settle = at.value("state", "") == to_hex(settle.state) ? GoldenState::kIdentical
                  : report.settle_distance <= kSettleTolerance  ? GoldenState::kClose
                                                                : GoldenState::kDiffers;
  return report;
}

Status write_golden_difference(const std::string& folder, const GoldenFrame& frame,
                               const std::string& png) {
  PROBE_ASSIGN(const GoldenFrame golden, load_golden(folder, frame.name));
  if (golden.rgb.size() != frame.rgb.size()) {
    return Failure{Fault::kAsset, "the stored picture has another size", frame.name};
  }
  std::vector<std::uint8_t> rows = golden.rgb;
  rows.insert(rows.end(), frame.rgb.begin(), frame.rgb.end());
  for (std::size_t k = 0; k < frame.rgb.size(); ++k) {
    rows.push_back(
        static_cast<std::uint8_t>(std::min(255, 4 * std::abs(golden.rgb[k] - frame.rgb[k]))));
  }
  return scene::write_png(png, frame.width, 3 * frame.height, rows);
}

}  // namespace probe::doctor
