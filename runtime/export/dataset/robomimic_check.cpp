// A robomimic file as it lies there, against what its traces make of it: a demonstration at a time,
// its pictures some at a time.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "runtime/base/json.h"
#include "runtime/export/dataset/findings.h"
#include "runtime/export/dataset/format_checks.h"
#include "runtime/export/dataset/robomimic.h"
#include "runtime/export/dataset/robomimic_file.h"

namespace probe::dataset {
namespace {

class RobomimicCheck {
 public:
  RobomimicCheck(std::string path, NamedRuns runs, PicturesAgain* again)
      : path_(std::move(path)),
        file_(path_),
        runs_(std::move(runs)),
        again_(again),
        shape_(runs_.shape()) {}

  Result<CheckReport> check() {
    const bool is_whole = each_episode(
        runs_, findings_,
        [&](const auto& named, const auto& wording, bool) { return episode(named, wording); });
    if (!is_whole) return findings_.report;
    PROBE_ASSIGN(const RobomimicHead head, file_.head());
    expect(static_cast<std::int64_t>(head.demonstrations) == findings_.report.episodes, path_,
           fmt::format("data has {} demonstrations, the runs {}", head.demonstrations,
                       findings_.report.episodes));
    expect(head.total == findings_.report.frames, path_, "total is not the number of all samples");
    const Json env = Json::parse(head.env_args);
    for (const char* key : {"env_name", "env_type", "env_kwargs"})
      expect(env.contains(key), path_, std::string("env_args has no ") + key);
    if (!head.has_mask) return Failure{Fault::kIo, "mask cannot be read", path_};
    expect(head.success == successes_, path_, "mask/success is not what succeeded");
    expect(head.failure == failures_, path_, "mask/failure is not what failed");
    const std::set<std::string> train(head.train.begin(), head.train.end());
    std::set<std::string> all(successes_.begin(), successes_.end());
    all.insert(failures_.begin(), failures_.end());
    expect(train == all, path_, "mask/train is not all of them");
    return findings_.report;
  }

 private:
  void expect(bool is_so, const std::string& where, const std::string& what) {
    findings_.expect(is_so, where, what);
  }

  Status episode(const NamedDemonstration& named, const std::string& wording) {
    const std::string name = "demo_" + std::to_string(findings_.report.episodes);
    const std::string where = fmt::format("{} ({})", name, named.name);
    const auto& steps = named.trace.steps;
    const std::size_t n = steps.size(), joints = shape_.joints.size(),
                      width = steps.empty() ? 0 : steps.front().action.size();
    PROBE_ASSIGN(const RobomimicDemo demo, file_.demo(name, {n, joints, width}, where));
    expect(demo.samples == static_cast<std::int64_t>(n), where, "num_samples is not its trace's");
    const auto row = [](const std::vector<double>& of, std::size_t i, std::size_t size) {
      return std::span(of).subspan(i * size, size);
    };
    for (std::size_t i = 0; i < n; ++i) {
      const std::string at = fmt::format("{} step {}", where, i);
      const bool is_last = i + 1 == n;
      const auto q = joints_before(named.trace, i, joints);
      expect(std::ranges::equal(row(demo.actions, i, width), steps[i].action), at,
             "actions is not the trace's");
      expect(std::ranges::equal(row(demo.joints, i, joints), q), at,
             "obs/joints are not the trace's");
      expect(std::ranges::equal(row(demo.states, i, joints), q), at, "states are not the trace's");
      expect_state(findings_, row(demo.state, i, kStateSize), named.base,
                   sample_before(named.trace, i), at, "obs/state");
      expect(demo.rewards[i] == (is_last && named.success ? 1 : 0), at,
             "rewards is not the verdict");
      expect(demo.dones[i] == (is_last ? 1 : 0), at, "dones is not 1 in the last step alone");
    }
    PROBE_TRY(pictures(name, named, where));
    const Json meta = Json::parse(demo.meta);
    expect(meta.value("lang", "") == wording, where, "lang of ep_meta is not its wording");
    const Json* success = meta.find("success");
    expect(success != nullptr && success->is_boolean() && success->get<bool>() == named.success,
           where, "success of ep_meta is not the verdict");
    (named.success ? successes_ : failures_).push_back(name);
    return {};
  }

  // Of every camera, frame by frame.
  Status pictures(const std::string& name, const NamedDemonstration& named,
                  const std::string& where) {
    const std::size_t n = named.trace.steps.size();
    const auto wanted = picture_hashes(findings_, named, again_);
    for (std::size_t first = 0;;) {
      PROBE_ASSIGN(const RobomimicPictures some,
                   file_.pictures(name, shape_.cameras, n, first, where));
      for (std::size_t i = 0; i < some.steps(); ++i, ++first)
        expect_pictures(findings_, some.step(i), wanted, first,
                        fmt::format("{} step {}", where, first));
      if (first == n) return {};
    }
  }

  std::string path_;
  RobomimicFile file_;
  NamedRuns runs_;
  PicturesAgain* again_;
  Shape shape_;
  Findings findings_;
  std::vector<std::string> successes_, failures_;
};

}  // namespace

Result<CheckReport> check_robomimic(const std::string& dir, NamedRuns runs, PicturesAgain* again) {
  const std::string path = dir + "/" + robomimic::kFile;
  if (const Status open = RobomimicFile(path).open(); !open) {
    CheckReport report;
    report.problems.push_back(to_text(open.failure()));
    return report;
  }
  return RobomimicCheck(path, std::move(runs), again).check();
}

}  // namespace probe::dataset
