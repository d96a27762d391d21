#include "runtime/export/dataset/finished_films.h"

#include <filesystem>
#include <limits>

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"

namespace probe::dataset {
namespace {

std::string path_of(const std::string& dir, const std::string& trace_sha256) {
  return dir + "/" + trace_sha256;
}

}  // namespace

// The hash of all that follows; the steps; the film.
std::optional<Finished> FinishedFilms::find(const std::string& trace_sha256,
                                            std::size_t steps) const {
  const std::string path = path_of(dir_, trace_sha256);
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return std::nullopt;
  const auto read = read_file(path, {.most = std::numeric_limits<std::size_t>::max()});
  if (!read) return std::nullopt;
  ByteReader bytes(std::as_bytes(std::span(*read)));
  const Sha256 told = bytes.hash();
  if (!bytes.ok() || told != sha256(std::as_bytes(std::span(*read)).subspan(bytes.position())))
    return std::nullopt;
  Finished finished;
  if (bytes.u32() != steps) return std::nullopt;
  for (std::size_t i = 0; i < steps && bytes.ok(); ++i) {
    Step step;
    for (double& number : step.state) number = bytes.f64();
    step.joints = bytes.reals();
    const std::vector<double> action = bytes.reals();
    if (action.size() > robot::kMostActionNumbers) return std::nullopt;
    step.action = robot::Action(action);
    finished.steps.push_back(std::move(step));
  }
  if (!bytes.ok()) return std::nullopt;
  finished.film = layout_.film_of(bytes);
  if (finished.film == nullptr || bytes.left() != 0) return std::nullopt;
  return finished;
}

Status FinishedFilms::keep(const std::string& trace_sha256, const Finished& finished) const {
  ByteWriter bytes;
  bytes.u32(static_cast<std::uint32_t>(finished.steps.size()));
  for (const Step& step : finished.steps) {
    for (const double number : step.state) bytes.f64(number);
    bytes.reals(step.joints);
    bytes.reals({step.action.data(), step.action.size()});
  }
  finished.film->write(bytes);
  ByteWriter told;
  told.hash(sha256(bytes.bytes()));
  std::vector<std::byte> all = told.bytes();
  all.insert(all.end(), bytes.bytes().begin(), bytes.bytes().end());
  return write_file(path_of(dir_, trace_sha256), all);
}

}  // namespace probe::dataset
