#include "runtime/api/questions.h"

#include <algorithm>
#include <array>
#include <new>
#include <string_view>
#include <utility>

#include "runtime/api/arrays.h"
#include "runtime/robot/action_space.h"

namespace probe::api {
namespace {

std::chrono::nanoseconds in_clock(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

// Whether one array holds the pictures of both, and one their joints.
bool are_alike(const vlaprobe_question& a, const vlaprobe_question& b) {
  if (a.picture_count != b.picture_count || a.joints.shape[0] != b.joints.shape[0] ||
      a.action_size != b.action_size)
    return false;
  for (std::size_t i = 0; i < a.picture_count; ++i) {
    if (std::string_view(a.pictures[i].camera) != b.pictures[i].camera) return false;
    if (!std::ranges::equal(a.pictures[i].rgb.shape, b.pictures[i].rgb.shape)) return false;
  }
  return true;
}

}  // namespace

int Questions::come() {
  const std::lock_guard lock(mutex_);
  const auto free = std::ranges::find(here_, false);
  if (free == here_.end()) {
    here_.push_back(true);
    return static_cast<int>(here_.size()) - 1;
  }
  *free = true;
  return static_cast<int>(free - here_.begin());
}

void Questions::go(int world) {
  {
    const std::lock_guard lock(mutex_);
    here_[static_cast<std::size_t>(world)] = false;
  }
  changed_.notify_all();
}

bool Questions::is_due(Clock::time_point now) const {
  const auto here = static_cast<std::size_t>(std::ranges::count(here_, true));
  if (waiting_.size() >= std::min(options_.most, here)) return true;
  return now - waiting_.front()->since >= in_clock(options_.gather_s);
}

std::vector<Questions::Waiting*> Questions::take() {
  std::vector<Waiting*> batch;
  const vlaprobe_question& first = *waiting_.front()->question;
  std::erase_if(waiting_, [&](Waiting* one) {
    if (batch.size() >= options_.most || !are_alike(first, *one->question)) return false;
    batch.push_back(one);
    return true;
  });
  // The same worlds come in the same order, whoever was first.
  std::ranges::sort(batch, {}, [](const Waiting* one) { return one->question->world; });
  return batch;
}

void Questions::answer(const std::vector<Waiting*>& batch) const {
  std::vector<vlaprobe_question> asked;
  for (const Waiting* one : batch) asked.push_back(*one->question);
  const std::size_t size = asked.front().action_size;
  std::vector<double> actions(batch.size() * size);
  vlaprobe_refusals refusals{std::vector<std::optional<std::string>>(batch.size())};
  options_.act(options_.user, asked.data(), asked.size(), actions.data(), &refusals);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (refusals.why[i]) {
      batch[i]->answer = Failure{Fault::kPolicy, *refusals.why[i], ""};
      continue;
    }
    batch[i]->answer = policy::Action(std::span<const double>(actions).subspan(i * size, size));
  }
}

Result<policy::Action> Questions::ask(const vlaprobe_question& question) {
  constexpr auto kLookAround = std::chrono::milliseconds(100);  // for the end of the run
  Waiting own{&question, Clock::now()};
  std::unique_lock lock(mutex_);
  waiting_.push_back(&own);
  changed_.notify_all();
  while (!own.answer) {
    const bool is_in_line = std::ranges::find(waiting_, &own) != waiting_.end();
    if (is_in_line && options_.stopped && options_.stopped()) {
      std::erase(waiting_, &own);
      return Failure{Fault::kPolicy, "the run was stopped", ""};
    }
    if (!is_busy_ && is_in_line && is_due(Clock::now())) {
      is_busy_ = true;
      const std::vector<Waiting*> batch = take();
      lock.unlock();
      answer(batch);
      lock.lock();
      is_busy_ = false;
      changed_.notify_all();
      continue;
    }
    auto until = Clock::now() + kLookAround;
    if (!is_busy_ && is_in_line)
      until = std::min(until, waiting_.front()->since + in_clock(options_.gather_s));
    changed_.wait_until(lock, until);
  }
  return *own.answer;
}

namespace {

class Asking : public policy::Policy {
 public:
  explicit Asking(std::shared_ptr<Questions> questions) : questions_(std::move(questions)) {}
  ~Asking() override { leave(); }

  Status begin(const policy::EpisodeStart& start) override {
    leave();
    task_ = std::string(start.task);
    prompt_ = std::string(start.prompt);
    question_ = {};
    question_.episode = start.index;
    question_.seed = start.seed;
    question_.draw_seed = start.draw_seed;
    question_.horizon = start.horizon;
    question_.action_size =
        start.robot == nullptr ? robot::kActionSize : robot::action_space_of(*start.robot).size();
    question_.task = task_.c_str();
    question_.instruction = prompt_.c_str();
    question_.world = questions_->come();
    is_here_ = true;
    return {};
  }

  Result<policy::Action> act(const policy::Observation& seen) override {
    names_.clear();
    pictures_.clear();
    for (const policy::CameraImage& camera : seen.cameras) names_.emplace_back(camera.camera);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const policy::Image& image = seen.cameras[i].image;
      pictures_.push_back(
          {names_[i].c_str(), array_of(image.rgb, {static_cast<std::size_t>(image.height),
                                                   static_cast<std::size_t>(image.width), 3})});
    }
    const policy::Proprioception& robot = seen.proprioception;
    const Vec3& p = robot.tcp_in_base.position;
    const Quat& q = robot.tcp_in_base.rotation;
    std::ranges::copy(std::array{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}, question_.tool);
    question_.openness = robot.openness;
    question_.joints = array_of(std::span<const double>(robot.joints), {robot.joints.size()});
    question_.step = seen.step;
    prompt_ = std::string(seen.prompt);
    question_.instruction = prompt_.c_str();
    question_.pictures = pictures_.data();
    question_.picture_count = pictures_.size();
    return questions_->ask(question_);
  }

  void end(const policy::EpisodeEnd& /*end*/) override { leave(); }

 private:
  void leave() {
    if (is_here_) questions_->go(question_.world);
    is_here_ = false;
  }

  std::shared_ptr<Questions> questions_;
  bool is_here_ = false;
  vlaprobe_question question_{};
  std::string task_, prompt_;
  std::vector<std::string> names_;
  std::vector<vlaprobe_camera_picture> pictures_;
};

}  // namespace

std::unique_ptr<policy::Policy> make_asking(std::shared_ptr<Questions> questions) {
  return std::make_unique<Asking>(std::move(questions));
}

}  // namespace probe::api

extern "C" void vlaprobe_refuse(vlaprobe_refusals* refusals, size_t question, const char* why) {
  if (refusals == nullptr || question >= refusals->why.size() || refusals->why[question]) return;
  try {
    refusals->why[question] = why == nullptr ? "no reason was given" : why;
  } catch (const std::bad_alloc&) {
    refusals->why[question].emplace();  // no memory even for the reason
  }
}
