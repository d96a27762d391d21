#include "runtime/ask/picture.h"

#include <algorithm>

#include "runtime/base/check.h"
#include "runtime/base/sha256.h"
#include "runtime/scene/image.h"
#include "runtime/servers/resize.h"
#include "runtime/vm/claims.h"
#include "runtime/vm/judge.h"
#include "runtime/wire/base64.h"

namespace probe::ask {
namespace {

constexpr std::size_t kStagesKept = 2;

servers::ImageRule image_rule(const PictureRule& rule) {
  servers::ImageRule image;
  image.width = rule.width;
  image.height = rule.height;
  image.resize = rule.resize;
  return image;
}

bool as_rendered(const View& view, const PictureRule& rule) {
  return rule.width == 0 || (rule.width == view.width && rule.height == view.height);
}

}  // namespace

Result<stage::Stage*> Viewer::stage_of(std::uint32_t task) {
  const auto has_task = [task](const auto& stage) { return stage->task() == task; };
  const auto known = std::ranges::find_if(stages_, has_task);
  if (known != stages_.end()) {
    stages_.splice(stages_.begin(), stages_, known);
    return stages_.front().get();
  }
  if (stages_.size() >= kStagesKept) stages_.pop_back();  // frees it before the new one is made
  PROBE_ASSIGN(auto made, stage::Stage::create(plan_, task, assets_));
  stages_.push_front(std::move(made));
  return stages_.front().get();
}

Result<View> Viewer::look(stage::Stage& stage) {
  PROBE_TRY(stage.observe());
  std::string known;
  for (const stage::CameraFrame& seen : stage.frames()) {
    known += (known.empty() ? "`" : ", `") + std::string(seen.camera) + "`";
    if (!rule_.camera.empty() && seen.camera != rule_.camera) continue;
    const render::FrameView& frame = seen.frame;
    return View{frame.width,
                frame.height,
                {frame.rgb.begin(), frame.rgb.end()},
                {frame.depth.begin(), frame.depth.end()},
                {frame.segmentation.begin(), frame.segmentation.end()}};
  }
  const plan::TaskRecord& task = plan_.tasks()[stage.task()];
  return Failure{Fault::kUsage,
                 "task `" + std::string(plan_.text(task.name)) + "` has no camera `" +
                     rule_.camera + "`, but " + known,
                 "--model"};
}

Result<View> Viewer::start(std::uint32_t episode) {
  const plan::EpisodeRecord& record = plan_.episodes()[episode];
  PROBE_ASSIGN(stage::Stage * stage, stage_of(record.task));
  PROBE_TRY(stage->reset(record.index));
  PROBE_TRY(vm::check_claims(plan_, record.task, stage->body_starts(), stage->sample()));
  return look(*stage);
}

Result<bool> Viewer::judge_start(const plan::QuestionRecord& question) const {
  const stage::Stage& stage = *stages_.front();
  PROBE_CHECK(stage.task() == question.task, "the start that was looked at is of this task");
  vm::Judge judge(plan_, question.task, question.program);
  PROBE_TRY(judge.begin(stage.body_starts()));
  PROBE_TRY(judge.step(stage.sample()));
  return judge.truth(0);
}

Result<View> Viewer::end(std::uint32_t episode, const store::Trace& trace) {
  const plan::EpisodeRecord& record = plan_.episodes()[episode];
  PROBE_ASSIGN(stage::Stage * stage, stage_of(record.task));
  PROBE_TRY(stage->reset(record.index));
  for (const store::TraceStep& step : trace.steps) PROBE_TRY(stage->step(step.action));
  const Sha256* last = !trace.steps.empty() ? &trace.steps.back().state_hash
                       : trace.start        ? &trace.start->state_hash
                                            : nullptr;
  if (last == nullptr || *last != stage->state_hash()) {
    return Failure{Fault::kTrace,
                   "its actions lead to another end on this machine or build, so that the picture "
                   "of its end cannot be drawn",
                   ""};
  }
  return look(*stage);
}

std::pair<int, int> sent_size(const View& view, const PictureRule& rule) {
  if (as_rendered(view, rule)) return {view.width, view.height};
  return {rule.width, rule.height};
}

Result<SentPicture> to_sent(const View& view, const PictureRule& rule) {
  SentPicture sent;
  std::tie(sent.width, sent.height) = sent_size(view, rule);
  if (as_rendered(view, rule)) {
    PROBE_ASSIGN(sent.png,
                 scene::png_bytes(view.width, view.height, view.rgb, scene::PngEffort::kFastest));
  } else {
    const wire::Array pixels =
        servers::to_pixels({view.width, view.height, view.rgb}, image_rule(rule));
    PROBE_ASSIGN(sent.png, scene::png_bytes(sent.width, sent.height, pixels.bytes,
                                            scene::PngEffort::kFastest));
  }
  sent.sha256 = to_hex(probe::sha256(std::string_view(sent.png)));
  return sent;
}

View sent_part(const View& view, const PictureRule& rule) {
  const servers::SentPart part = servers::sent_part(view.width, view.height, image_rule(rule));
  View sent{part.width, part.height, {}, {}, {}};
  for (int y = part.top; y < part.top + part.height; ++y) {
    const std::ptrdiff_t begin = std::ptrdiff_t{y} * view.width + part.left;
    const auto depth = view.depth.begin() + begin;
    const auto bodies = view.segmentation.begin() + begin;
    sent.depth.insert(sent.depth.end(), depth, depth + part.width);
    sent.segmentation.insert(sent.segmentation.end(), bodies, bodies + part.width);
  }
  return sent;
}

std::vector<bool> sent_mask(const View& view, const PictureRule& rule, std::uint32_t body) {
  std::vector<bool> mask;
  if (as_rendered(view, rule)) {
    for (const std::uint16_t seen : view.segmentation) mask.push_back(seen == body + 1);
    return mask;
  }
  constexpr std::uint8_t kFull = 255, kHalf = 128;
  std::vector<std::uint8_t> shape;
  shape.reserve(view.rgb.size());
  for (const std::uint16_t seen : view.segmentation)
    shape.insert(shape.end(), 3, seen == body + 1 ? kFull : std::uint8_t{0});
  const wire::Array pixels = servers::to_pixels({view.width, view.height, shape}, image_rule(rule));
  for (std::size_t i = 0; i < pixels.bytes.size(); i += 3) mask.push_back(pixels.bytes[i] >= kHalf);
  return mask;
}

std::string data_uri_of(std::string_view png) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(png.data());
  return "data:image/png;base64," + wire::to_base64({bytes, png.size()});
}

}  // namespace probe::ask
