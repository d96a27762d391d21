#include "compiler/emit/assets.h"

#include <filesystem>
#include <fstream>
#include <optional>

namespace probe::emit {
namespace {

std::optional<std::vector<std::byte>> read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return std::nullopt;
  const std::streamoff size = in.tellg();
  if (size < 0) return std::nullopt;
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!in) return std::nullopt;
  return bytes;
}

}  // namespace

std::uint32_t AssetTable::add(const std::string& path, plan::AssetKind kind, const Span& span) {
  const auto [at, is_new] = known_.try_emplace({path, kind}, plan::kNone);
  if (!is_new) return at->second;
  const std::filesystem::path file = std::filesystem::path(root_) / path;
  const auto miss = [&](const char* why) {
    diagnostics_.report(Code::P0202, span, "asset `" + path + "` " + why)
        .note("looked for it in the assets folder `" + root_ + "`");
    return plan::kNone;
  };
  // A path leads below the root, so that a plan means the same files wherever the root lies.
  const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
  if (normal.is_absolute() || normal.begin() == normal.end() || *normal.begin() == "..") {
    return miss("leads out of the assets folder");
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return miss("is not there");
  Asset asset{path, kind, 0, {}};
  if (hashes_) {
    const auto bytes = read_bytes(file);
    if (!bytes) return miss("cannot be read");
    if (bytes->empty()) return miss("is empty");
    asset.byte_size = bytes->size();
    asset.hash = sha256(std::span<const std::byte>(*bytes));
  }
  assets_.push_back(std::move(asset));
  return at->second = static_cast<std::uint32_t>(assets_.size() - 1);
}

}  // namespace probe::emit
