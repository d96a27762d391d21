#include "runtime/export/dataset/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/export/dataset/pictures.h"

namespace probe::dataset {
namespace {

constexpr std::size_t kMostProblems = 50;

std::string without_numbers(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
  return text;
}

}  // namespace

void Findings::expect(bool is_so, const std::string& where, const std::string& what) {
  if (is_so) return;
  const auto [kind, is_new] = kinds_.try_emplace(without_numbers(what));
  Kind& known = kind->second;
  if (is_new) {
    known = {where + ": " + what, report.problems.size(), 0};
    problem(known.first);
    return;
  }
  ++known.more;
  report.problems[known.index] = fmt::format("{} (and {} more like it)", known.first, known.more);
}

bool Findings::is_full() const { return report.problems.size() >= kMostProblems; }

bool each_episode(NamedRuns& runs, Findings& findings,
                  const std::function<Status(const NamedDemonstration& named,
                                             const std::string& wording, bool is_first)>& episode) {
  for (;;) {
    const auto named = runs.next();
    if (!named) {
      findings.problem(to_text(named.failure()));
      return false;
    }
    if (!*named) return true;
    ++findings.report.demonstrations;
    for (std::size_t i = 0; i < (*named)->wordings.size(); ++i) {
      if (const Status one = episode(**named, (*named)->wordings[i], i == 0); !one) {
        findings.problem(to_text(one.failure()));
        return false;
      }
      ++findings.report.episodes;
      findings.report.frames += static_cast<std::int64_t>((*named)->trace.steps.size());
      if (findings.is_full()) return false;
    }
  }
}

const vm::StepSample& sample_before(const store::Trace& trace, std::size_t i) {
  return i == 0 ? trace.start->sample : trace.steps[i - 1].sample;
}

std::span<const double> joints_before(const store::Trace& trace, std::size_t i, std::size_t count) {
  const std::vector<double>& q = i == 0 ? trace.start->q : trace.steps[i - 1].q;
  return std::span(q).first(std::min(count, q.size()));
}

void expect_state(Findings& findings, std::span<const double> state, const Pose& base,
                  const vm::StepSample& sample, const std::string& at, const std::string& called) {
  constexpr double kNear = 1e-6;  // floats of metres
  if (state.size() != kStateSize) return findings.expect(false, at, called + " has another size");
  const Vec3 place = base.inverse().apply(sample.tcp);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    findings.expect(
        std::abs(state[k] - place[i]) < kNear, at,
        fmt::format("{} {} is {}, the trace's {}", called, kStateNames[k], state[k], place[i]));
  }
  for (std::size_t i = 3; i < 6; ++i)
    findings.expect(std::abs(state[i]) <= std::numbers::pi + kNear, at,
                    fmt::format("{} {} is no angle", called, kStateNames[i]));
  findings.expect(std::abs(state[6] - (1 - sample.grip)) < kNear, at,
                  called + " gripper is not the trace's");
}

std::vector<Sha256> picture_hashes(Findings& findings, const NamedDemonstration& named,
                                   PicturesAgain* again) {
  std::vector<Sha256> hashes;
  if (named.has_all_pictures) {
    for (const store::TraceStep& step : named.trace.steps) hashes.push_back(step.image_hash);
  } else if (again != nullptr) {
    if (const auto drawn = again->hashes(named)) {
      hashes.assign(drawn->begin(), drawn->end());
    } else {
      findings.problem(to_text(drawn.failure()));
    }
  } else {
    findings.report.not_redrawn += static_cast<std::int64_t>(named.trace.steps.size());
  }
  return hashes;
}

void expect_pictures(Findings& findings, std::span<const std::span<const std::uint8_t>> rgb,
                     std::span<const Sha256> wanted, std::size_t step, const std::string& at) {
  if (step >= wanted.size()) return;
  findings.expect(hash_of(rgb) == wanted[step], at,
                  "its pictures are not those that the policy saw");
}

bool equal_singles(std::span<const double> stored, std::span<const double> wanted) {
  return std::ranges::equal(stored, wanted, [](double a, double b) {
    return a == static_cast<double>(static_cast<float>(b));
  });
}

}  // namespace probe::dataset
