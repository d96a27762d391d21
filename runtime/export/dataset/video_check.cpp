#include "runtime/export/dataset/video_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace probe::dataset {
namespace {

using Pixels = std::vector<std::uint8_t>;

double rms(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int difference = static_cast<int>(a[i]) - static_cast<int>(b[i]);
    sum += difference * difference;
  }
  return a.empty() ? 0 : std::sqrt(static_cast<double>(sum) / static_cast<double>(a.size()));
}

// Where two pictures differ by more than the codec does, and in how many places at least.
constexpr int kClearlyOther = 24;
constexpr int kLeastOther = 60;

// Of what clearly differs between `drawn` and `other`: whether the frame is clearly more like
// `other`. In a video that lags the squares are 20 to 100 times smaller; in a right one it
// happens by chance that a frame comes out nearer to its neighbour (1 of 1,822 of the kitchen,
// by 1.03).
constexpr std::int64_t kClearlyNearer = 4;
bool is_nearer_to(std::span<const std::uint8_t> other, std::span<const std::uint8_t> drawn,
                  std::span<const std::uint8_t> frame) {
  std::int64_t from_drawn = 0, from_other = 0, places = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const int a = drawn[i], b = other[i], f = frame[i];
    if (std::abs(a - b) <= kClearlyOther) continue;
    ++places;
    from_drawn += (f - a) * (f - a);
    from_other += (f - b) * (f - b);
  }
  return places >= kLeastOther && kClearlyNearer * from_other < from_drawn;
}

// Of a camera, one step back: as it was drawn and as the video has it.
struct Before {
  Pixels drawn, shown;
};

}  // namespace

bool VideoCheck::go_to(Findings& findings, Film& film, const VideoStretch& stretch) {
  if (film.path != stretch.path) {
    film = {stretch.path, nullptr, 0};
    auto reader = show::ClipReader::create(stretch.path);
    if (!reader) {
      findings.problem(to_text(reader.failure()));
      return false;
    }
    film.reader = std::move(*reader);
  }
  for (; film.reader && film.next < stretch.begin; ++film.next) {
    const auto skipped = film.reader->next();
    if (skipped.ok() && !skipped->empty()) continue;
    findings.problem(skipped ? stretch.path + ": ends before the demonstration begins"
                             : to_text(skipped.failure()));
    film.reader.reset();
    return false;
  }
  // A stretch that begins before is told where its numbers are checked.
  return film.reader && film.next == stretch.begin;
}

void VideoCheck::check(Findings& findings, const NamedDemonstration& named,
                       const std::vector<VideoStretch>& stretches, const std::string& where) {
  films_.resize(stretches.size());
  std::vector<bool> is_read;
  for (std::size_t i = 0; i < stretches.size(); ++i)
    is_read.push_back(go_to(findings, films_[i], stretches[i]));
  std::vector<Before> before(stretches.size());
  const auto look = [&](std::span<const Picture> pictures, std::size_t step) -> Status {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      if (!is_read[i]) continue;
      const auto& [camera, drawn] = pictures[i];
      const std::string at =
          fmt::format("{} frame {} of `{}` in {}", where, step, camera->name, films_[i].path);
      const auto frame = films_[i].reader->next();
      if (!frame || frame->size() != drawn.size()) {
        findings.problem(frame ? at + ": is not there, nor is what follows"
                               : to_text(frame.failure()));
        films_[i].reader.reset();
        is_read[i] = false;
        continue;
      }
      ++films_[i].next;
      const double error = rms(*frame, drawn);
      findings.expect(error <= kMostVideoError, at,
                      fmt::format("is {:.1f} of 255 away from what the policy saw", error));
      if (step > 0) {
        const auto& [drawn_before, shown_before] = before[i];
        findings.expect(!is_nearer_to(drawn_before, drawn, *frame), at,
                        "shows what the policy saw a step earlier");
        findings.expect(!is_nearer_to(drawn, drawn_before, shown_before), at,
                        "is shown a step earlier");
      }
      before[i] = {Pixels(drawn.begin(), drawn.end()), Pixels(frame->begin(), frame->end())};
    }
    return {};
  };
  if (const Status drawn = again_.draw(named, look); !drawn)
    findings.problem(to_text(drawn.failure()));
}

}  // namespace probe::dataset
