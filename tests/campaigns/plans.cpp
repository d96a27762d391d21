// Every plan that the verifier accepts runs or is refused by name: valid plans with some of their
// numbers and indices replaced, their hashes made right. Each that is accepted begins an episode,
// draws its pictures, makes a step and does the same once more in another world. Nothing may abort,
// hang or differ. Pictures are what takes longest, so three of four plans are seen in small ones.
//   campaign_plans FILE.. [--for SECONDS | --count N] [--from SEED] [--only SEED]
// A seed is one mutation, always the same. Exit 0: no finding.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/stage.h"
#include "tests/campaigns/base.h"
#include "tests/campaigns/driver.h"
#include "tests/plan/rule_of.h"
#include "tests/plan/seal.h"

namespace {

using namespace probe;
using plan::Section;
using test::Bytes;

// What came of a seed.
enum class Came : std::uint8_t { kRefused, kNotMade, kNotBegun, kNotStepped, kRan, kCount };
constexpr const char* kCame[] = {"refused by the verifier", "refused as it is made",
                                 "invalid as it begins", "invalid in its step", "ran twice alike"};

constexpr std::size_t kRules = static_cast<std::size_t>(Came::kCount);  // counts of rules behind

using campaign::Base;
constexpr const char* kName = "campaign_plans";

class Mutation {
 public:
  explicit Mutation(std::uint64_t seed) : random_(seed) {}

  // Whether files are still those of the plan before.
  bool apply(Bytes& bytes) {
    plan::Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    std::vector<plan::DirectoryEntry> sections(header.sections);
    std::memcpy(sections.data(), bytes.data() + sizeof header,
                sections.size() * sizeof sections[0]);
    std::erase_if(sections, [](const auto& section) { return section.size < 8; });
    const int count = below(3) == 0 ? 1 + static_cast<int>(below(4)) : 1;
    bool same_files = true;
    for (int i = 0; i < count; ++i) {
      const auto& section = sections[below(sections.size())];
      same_files = change(bytes, section) && same_files;
    }
    test::seal(bytes);
    return same_files;
  }
  std::uint64_t below(std::uint64_t most) { return random_() % most; }

 private:
  bool change(Bytes& bytes, const plan::DirectoryEntry& section) {
    const std::uint64_t at = section.offset + below(section.size / 8) * 8;
    double number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    const bool is_number =
        std::isfinite(number) && std::abs(number) > 1e-12 && std::abs(number) < 1e12;
    if (is_number || below(4) == 0) {
      number = other(number);
      std::memcpy(bytes.data() + at, &number, sizeof number);
    } else {
      const std::uint64_t half = at + below(2) * 4;
      std::uint32_t word = 0;
      std::memcpy(&word, bytes.data() + half, sizeof word);
      word = other(word, bytes, section);
      std::memcpy(bytes.data() + half, &word, sizeof word);
    }
    // Those that say which files there are and what is made of them.
    constexpr Section kOfFiles[] = {Section::kStrings,  Section::kList,   Section::kAssets,
                                    Section::kObjects,  Section::kRobots, Section::kScenes,
                                    Section::kTasks,    Section::kBodies, Section::kCovers,
                                    Section::kFixtures, Section::kParts,  Section::kShown};
    return std::ranges::find(kOfFiles, static_cast<Section>(section.kind)) == std::end(kOfFiles);
  }
  double other(double was) {
    constexpr double kOdd[] = {0,
                               5e-324,
                               1e-300,
                               1e-12,
                               1e-9,
                               1e-6,
                               1e-3,
                               0.999999,
                               1,
                               2,
                               3.14159265358979,
                               100,
                               1000,
                               2000,
                               1e4,
                               1e6,
                               1e8,
                               1e9,
                               1e12,
                               1e38,
                               1e300,
                               1.7976931348623157e308,
                               std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()};
    switch (below(5)) {
      case 0:
        return (below(2) == 0 ? 1 : -1) * kOdd[below(std::size(kOdd))];
      case 1:
        return -was;
      case 2:
        return was * std::pow(10, static_cast<double>(below(13)) - 6);
      case 3:
        return was * std::ldexp(static_cast<double>(below(1 << 20)), -19);
      default:
        return std::nextafter(was, below(2) == 0 ? 1e9 : -1e9);
    }
  }
  std::uint32_t other(std::uint32_t was, const Bytes& bytes, const plan::DirectoryEntry& section) {
    switch (below(6)) {
      case 0:
        return was + 1;
      case 1:
        return was - 1;
      case 2:
        return static_cast<std::uint32_t>(below(16));
      case 3:
        return plan::kNone;
      case 4:
        return was ^ (std::uint32_t{1} << below(32));
      default: {  // one that stands elsewhere in the section
        std::uint32_t word = 0;
        std::memcpy(&word, bytes.data() + section.offset + below(section.size / 4) * 4,
                    sizeof word);
        return word;
      }
    }
  }
  std::mt19937_64 random_;
};

// State and pictures as an episode begins and after its first step.
using Seen = std::vector<Sha256>;

Result<Seen> play(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                  const std::shared_ptr<const stage::SharedAssets>& assets,
                  const stage::StageOptions& options, Came& came) {
  Seen seen;
  came = Came::kNotMade;
  PROBE_ASSIGN(const auto stage, stage::Stage::create(plan, task, assets, options));
  came = Came::kNotBegun;
  const auto look = [&]() -> Status {
    PROBE_ASSIGN([[maybe_unused]] const policy::Observation seen_now, stage->observe());
    seen.push_back(stage->state_hash());
    for (const stage::CameraFrame& camera : stage->frames()) {
      const auto& rgb = camera.frame.rgb;
      seen.push_back(sha256(std::as_bytes(std::span(rgb))));
    }
    return {};
  };
  PROBE_TRY(stage->reset(start));
  PROBE_TRY(look());
  came = Came::kNotStepped;
  policy::Action action{0.3, -0.4, 0.2, 0.1, 0, 0.1, -1};
  PROBE_TRY(stage->step(action));
  PROBE_TRY(look());
  for (const double value : stage->q()) {
    if (!std::isfinite(value))
      return Failure{Fault::kInternal, "a joint is not finite and nothing said so", ""};
  }
  came = Came::kRan;
  return seen;
}

void try_one(const std::vector<Base>& bases, campaign::Tally& tally) {
  Mutation mutation(tally.seed);
  const Base& base = bases[mutation.below(bases.size())];
  const auto valid = base.plan.bytes();
  Bytes bytes(valid.begin(), valid.end());
  const bool same_files = mutation.apply(bytes);
  const auto count = [&](Came came) { ++tally.counts[static_cast<std::size_t>(came)]; };
  const auto plan = plan::Plan::from_bytes(std::move(bytes), {.identity = false});
  if (!plan) {
    count(Came::kRefused);
    const plan::RuleInfo* rule = plan::rule_of(plan.failure());
    if (rule == nullptr) {
      tally.find("a refusal without a rule: " + to_text(plan.failure()));
    } else {
      ++tally.counts[kRules + static_cast<std::size_t>(rule - plan::all_rules().data())];
    }
    return;
  }
  const auto task = static_cast<std::uint32_t>(mutation.below(plan->tasks().size()));
  const auto episodes = plan->episodes(plan->tasks()[task]).size();
  const auto start = static_cast<std::uint32_t>(mutation.below(std::max<std::size_t>(1, episodes)));
  std::shared_ptr<const stage::SharedAssets> files = base.assets;
  if (!same_files) {
    const std::uint32_t tasks[] = {task};
    auto loaded = stage::SharedAssets::load(*plan, campaign::asset_root(), tasks);
    if (!loaded) return count(Came::kNotMade);
    files = *loaded;
  }
  stage::StageOptions options;
  if (mutation.below(4) != 0) options.image = {80, 60};
  Came came = Came::kRan, again = Came::kRan;
  const auto first = play(*plan, task, start, files, options, came);
  const auto second = play(*plan, task, start, files, options, again);
  count(came);
  const auto text = [](const Result<Seen>& seen) {
    return seen.ok() ? std::string("ran") : to_text(seen.failure());
  };
  if (came != again || text(first) != text(second) || (first.ok() && *first != *second)) {
    tally.find("differs when it is done again: " + text(first) + "; " + text(second));
  } else if (!first.ok() && first.failure().code == Fault::kInternal) {
    tally.find(text(first));
  }
}

void say(const campaign::Tally& tally) {
  for (std::size_t i = 0; i < kRules; ++i)
    std::printf("%9llu %s\n", static_cast<unsigned long long>(tally.counts[i]), kCame[i]);
  std::vector<std::pair<std::uint64_t, std::string>> rules;
  for (std::size_t i = 0; i < plan::all_rules().size(); ++i) {
    if (tally.counts[kRules + i] > 0)
      rules.emplace_back(tally.counts[kRules + i], std::string(plan::all_rules()[i].id));
  }
  std::ranges::sort(rules, std::ranges::greater());
  std::printf("%zu rules refused; most:", rules.size());
  for (std::size_t i = 0; i < rules.size() && i < 8; ++i)
    std::printf(" %s %llu", rules[i].second.c_str(),
                static_cast<unsigned long long>(rules[i].first));
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const campaign::Options options = campaign::read_options(kName, argc, argv);
  const std::vector<Base> bases = campaign::bases_of(kName, options);
  return campaign::run(
      options, {}, [&](campaign::Tally& tally) { try_one(bases, tally); }, say);
}
