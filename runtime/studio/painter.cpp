#include "runtime/studio/painter.h"

#include <algorithm>

#include "runtime/base/file.h"
#include "runtime/compile/files.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/top_view.h"
#include "runtime/studio/message.h"

namespace probe::studio {
namespace {

constexpr int kSmallWidth = 160;  // pixels

stage::ImageSize small_size(const plan::Plan& plan, std::uint32_t task) {
  const plan::CameraRecord& camera = plan.cameras()[plan.views(plan.tasks()[task]).front().camera];
  const double height = static_cast<double>(kSmallWidth) * camera.height / camera.width;
  return {kSmallWidth, std::max(1, static_cast<int>(height))};
}

}  // namespace

Painter::~Painter() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    stop_ = true;
  }
  wakes_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Painter::wish(Wish wish) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(wish);
    stop_ = true;
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  wakes_.notify_all();
}

std::shared_ptr<const Shown> Painter::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

void Painter::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wakes_.wait(lock, [&] { return ends_ || next_; });
    if (ends_) return;
    const Wish wish = std::move(*next_);
    next_.reset();
    stop_ = false;
    lock.unlock();
    paint(wish);
    lock.lock();
  }
}

void Painter::say(const Wish& wish, Json json) const {
  json["id"] = wish.id;
  tell_(message(json));
}

void Painter::paint(const Wish& wish) {
  const bool is_news = shown_ == nullptr || wish.texts != texts_ || is_changed_on_disk();
  if (is_news && !compile(wish)) return;
  const plan::Plan& plan = shown_->plan;
  const auto task = find_shown(*shown_, wish.task);
  if (!task) return say(wish, {{"kind", "failed"}, {"message", "the text has no task yet"}});
  const std::string name(plan.text(plan.tasks()[*task].name));
  if (auto drawn = draw(wish, *task); !drawn) {
    loaded_.reset();
    say(wish, {{"kind", "failed"}, {"task", name}, {"message", to_text(drawn.failure())}});
  }
  if (stop_) return;
  if (!is_told_) {
    is_told_ = true;
    say(wish, {{"kind", "tasks"}, {"task", name}, {"summary", summary(*shown_)}});
  }
  if (stop_ || top_of_ == name) return;
  draw_top(wish, *task);
  top_of_ = name;
}

// Another program may have written what the text uses.
bool Painter::is_changed_on_disk() const {
  return std::ranges::any_of(read_, [&](const auto& file) {
    if (texts_.contains(file.first)) return false;
    const auto now = read_file(file.first);
    return !now || *now != file.second;
  });
}

bool Painter::compile(const Wish& wish) {
  auto compiled = compile::compile_files({setting_.file}, {.assets = setting_.assets,
                                                           .library = setting_.library,
                                                           .unsaved = wish.texts,
                                                           .stop = &stop_});
  if (stop_) return false;
  if (!compiled) {
    say(wish, {{"kind", "broken"}, {"errors", 1}, {"message", to_text(compiled.failure())}});
    return false;
  }
  if (!compiled->ok) {
    Json broken = {{"kind", "broken"}, {"errors", compiled->diagnostics.error_count()}};
    for (const Diagnostic& said : compiled->diagnostics.items()) {
      if (said.severity != Severity::kError) continue;
      broken["message"] = said.message;
      if (!said.primary.is_none()) {
        const SourceFile& file = compiled->sources.file(said.primary.file);
        const auto place = file.line_column(said.primary.begin);
        broken["file"] = file.name();
        broken["line"] = place.line;
        broken["column"] = place.column;
      }
      break;
    }
    say(wish, std::move(broken));
    return false;
  }
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  if (!plan) {
    say(wish, {{"kind", "broken"}, {"errors", 1}, {"message", to_text(plan.failure())}});
    return false;
  }
  std::vector<bool> own = own_tasks(*plan, setting_.file);
  auto shown = std::make_shared<const Shown>(
      Shown{std::move(*plan), std::move(compiled->asset_root), std::move(compiled->referring), std::move(own)});
  texts_ = wish.texts;
  read_.clear();
  for (std::uint32_t i = 0; i < compiled->sources.size(); ++i) {
    const SourceFile& file = compiled->sources.file(FileId{i});
    read_.emplace(file.name(), file.text());
  }
  is_told_ = false;
  top_of_.clear();
  const std::lock_guard lock(mutex_);
  shown_ = std::move(shown);
  return true;
}

Status Painter::draw(const Wish& wish, std::uint32_t task) {
  const plan::Plan& plan = shown_->plan;
  if (plan.tasks()[task].episodes.count == 0)
    return Failure{Fault::kUsage, "the task has no starts", ""};
  const std::uint32_t start = wish.start < plan.tasks()[task].episodes.count ? wish.start : 0;
  if (loaded_ == nullptr || loaded_->shown != shown_ || loaded_->task != task) {
    auto loaded = std::make_unique<Loaded>();
    loaded->shown = shown_;
    loaded->task = task;
    // Who moves a thing or writes a comment waits for no file and no mesh.
    if (loaded_ != nullptr && loaded_->task == task &&
        stage::serves_both(loaded_->shown->plan, plan))
      loaded->assets = loaded_->assets;
    loaded_.reset();  // frees the old before the new is made
    if (loaded->assets == nullptr) {
      const std::uint32_t tasks[] = {task};
      PROBE_ASSIGN(loaded->assets, stage::SharedAssets::load(plan, shown_->asset_root, tasks));
    }
    PROBE_ASSIGN(loaded->small, stage::Stage::create(plan, task, loaded->assets,
                                                     {.image = small_size(plan, task)}));
    PROBE_ASSIGN(loaded->full, stage::Stage::create(plan, task, loaded->assets));
    loaded_ = std::move(loaded);
  }
  if (stop_) return {};
  const auto tell = [&](const stage::Stage& stage, const char* size) {
    tell_(picture_message({{"kind", "picture"},
                           {"id", wish.id},
                           {"task", plan.text(plan.tasks()[task].name)},
                           {"start", start},
                           {"size", size}},
                          stage.frames()));
  };
  PROBE_TRY(loaded_->small->reset(start));
  PROBE_TRY(loaded_->small->observe());
  tell(*loaded_->small, "small");
  if (stop_) return {};
  PROBE_TRY(loaded_->full->restore(loaded_->small->save()));
  PROBE_TRY(loaded_->full->observe());
  tell(*loaded_->full, "full");
  return {};
}

void Painter::draw_top(const Wish& wish, std::uint32_t task) {
  const plan::Plan& plan = shown_->plan;
  Json top = {{"kind", "top"}, {"task", plan.text(plan.tasks()[task].name)}};
  const auto view = inspect::top_view(plan, task, shown_->asset_root);
  if (view) {
    top["svg"] = inspect::to_svg(*view);
  } else {
    top["message"] = to_text(view.failure());
  }
  say(wish, std::move(top));
}

}  // namespace probe::studio
