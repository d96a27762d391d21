#include "runtime/ask/truth.h"

#include <cmath>

#include "runtime/ask/measured_parts.h"
#include "runtime/ask/wording.h"
#include "runtime/base/percent.h"
#include "runtime/plan/questions.h"

namespace probe::ask {
namespace {

// What a picture shows of a body.
struct Seen {
  std::uint32_t pixels = 0;
  double x = 0, y = 0;  // middle of these pixels, in pixels
  double depth = 0;     // their mean, m
};

Seen seen_of(const View& view, std::uint32_t body) {
  // Whole numbers first, so that no order of summing matters but depth's, which is the raster's.
  std::uint64_t x = 0, y = 0;
  double depth = 0;
  Seen seen;
  for (std::size_t i = 0; i < view.segmentation.size(); ++i) {
    if (view.segmentation[i] != body + 1) continue;
    ++seen.pixels;
    x += i % static_cast<std::size_t>(view.width);
    y += i / static_cast<std::size_t>(view.width);
    depth += static_cast<double>(view.depth[i]);
  }
  if (seen.pixels == 0) return seen;
  const double count = seen.pixels;
  seen.x = static_cast<double>(x) / count + 0.5;
  seen.y = static_cast<double>(y) / count + 0.5;
  seen.depth = depth / count;
  return seen;
}

Truth left_out(std::string why) {
  Truth truth;
  truth.left_out = std::move(why);
  return truth;
}

Truth hidden(std::string_view name, std::uint32_t pixels, const plan::FamilyRecord& family) {
  return left_out("hidden: `" + std::string(name) + "` shows " + std::to_string(pixels) + " of " +
                  std::to_string(family.pixels) + " pixels");
}

Truth yes_or_no(bool yes) {
  Truth truth;
  truth.yes = yes;
  truth.expected = yes ? "yes" : "no";
  return truth;
}

Truth proved(const plan::Plan& plan, const plan::QuestionRecord& question) {
  Truth truth;
  switch (plan::form_of(plan.families()[question.family])) {
    case plan::QuestionForm::kChoice:
      truth.option = question.right;
      truth.expected = std::string(plan.text(options_of(plan, question)[question.right].text));
      return truth;
    case plan::QuestionForm::kYesNo:
      return yes_or_no(question.right != 0);
    case plan::QuestionForm::kNumber:
      truth.number = question.right;
      truth.expected = std::to_string(question.right);
      return truth;
    case plan::QuestionForm::kPoint:
    case plan::QuestionForm::kFree:
      break;
  }
  return truth;
}

// The pixels of `option` as they are sent.
Truth area_of(const plan::Plan& plan, const plan::OptionRecord& option, const View& view,
              const PictureRule& rule) {
  Truth::Area area;
  std::tie(area.width, area.height) = sent_size(view, rule);
  area.mask = sent_mask(view, rule, option.body);
  const auto width = static_cast<std::size_t>(area.width);
  double x = 0, y = 0, count = 0;
  for (std::size_t i = 0; i < area.mask.size(); ++i) {
    if (!area.mask[i]) continue;
    x += static_cast<double>(i % width);
    y += static_cast<double>(i / width);
    ++count;
  }
  const std::string name(plan.text(option.text));
  if (count == 0) return left_out("hidden: `" + name + "` fills no pixel of the size that is sent");
  double nearest = -1;
  for (std::size_t i = 0; i < area.mask.size(); ++i) {
    if (!area.mask[i]) continue;
    const double dx = static_cast<double>(i % width) - x / count;
    const double dy = static_cast<double>(i / width) - y / count;
    const double square = dx * dx + dy * dy;
    if (nearest >= 0 && square >= nearest) continue;
    nearest = square;
    area.inside = {static_cast<double>(i % width), static_cast<double>(i / width)};
  }
  Truth truth;
  truth.expected = "on `" + name + "`, such as (" + decimal_text(area.inside.x, 0) + ", " +
                   decimal_text(area.inside.y, 0) + ")";
  truth.area = std::move(area);
  return truth;
}

}  // namespace

std::optional<Truth> known_truth(const plan::Plan& plan, const plan::QuestionRecord& question) {
  if (plan::truth_of(question) == plan::QuestionTruth::kProved) return proved(plan, question);
  if (plan::truth_of(question) != plan::QuestionTruth::kMentions) return std::nullopt;
  const auto options = options_of(plan, question);
  Truth truth;
  truth.expected = std::string(plan.text(options[question.a].text)) + ", " +
                   std::string(plan.text(options[question.b].text));
  return truth;
}

Truth find_truth(const plan::Plan& plan, const plan::QuestionRecord& question, const View& view,
                 const PictureRule& rule, std::optional<bool> judged) {
  // What a crop leaves out is not seen.
  const bool is_cropped = rule.width > 0 && rule.resize == servers::Resize::kCrop;
  const View cropped = is_cropped ? sent_part(view, rule) : View{};
  const View& sent = is_cropped ? cropped : view;
  const auto options = options_of(plan, question);
  const plan::FamilyRecord& family = plan.families()[question.family];
  for (const plan::OptionRecord& option : options) {
    if ((option.flags & plan::kMustBeSeen) == 0) continue;
    const std::uint32_t pixels = seen_of(sent, option.body).pixels;
    if (pixels >= family.pixels && pixels > 0) continue;
    return hidden(plan.text(option.text), pixels, family);
  }
  for (const MeasuredPart& part : measured_parts(plan, question)) {
    std::uint32_t pixels = 0;
    for (const std::uint32_t body : part.bodies) pixels += seen_of(sent, body).pixels;
    if (pixels >= family.pixels && pixels > 0) continue;
    return hidden(part.name, pixels, family);
  }
  const auto name = [&](std::uint32_t option) {
    return "`" + std::string(plan.text(options[option].text)) + "`";
  };
  switch (plan::truth_of(question)) {
    case plan::QuestionTruth::kProved:
    case plan::QuestionTruth::kMentions:
      return *known_truth(plan, question);
    case plan::QuestionTruth::kRecorded:
    case plan::QuestionTruth::kSettled:
      return judged ? yes_or_no(*judged) : left_out("nothing was judged");
    case plan::QuestionTruth::kPixelsOf:
      return area_of(plan, options[question.a], view, rule);
    case plan::QuestionTruth::kLeftOf:
    case plan::QuestionTruth::kNearerThan:
      break;
  }
  const Seen a = seen_of(sent, options[question.a].body);
  const Seen b = seen_of(sent, options[question.b].body);
  for (const auto& [seen, option] : {std::pair(a, question.a), std::pair(b, question.b)}) {
    if (seen.pixels == 0) return left_out("hidden: " + name(option) + " is not in the picture");
  }
  if (plan::truth_of(question) == plan::QuestionTruth::kLeftOf) {
    if (std::abs(a.x - b.x) < kLeastSideways * sent.width) {
      return left_out("the middles of " + name(question.a) + " and " + name(question.b) +
                      " are too close to say which is further left");
    }
    return yes_or_no(a.x < b.x);
  }
  if (std::abs(a.depth - b.depth) < kLeastNearer) {
    return left_out(name(question.a) + " and " + name(question.b) +
                    " are too equally far to say which is nearer");
  }
  return yes_or_no(a.depth < b.depth);
}

std::optional<bool> told_yes(std::string_view expected) {
  if (expected == "yes") return true;
  if (expected == "no") return false;
  return std::nullopt;
}

bool is_right(const Truth& truth, const Reading& reading) {
  if (reading.verdict != Verdict::kRead) return false;
  if (truth.option) return reading.option == truth.option;
  if (truth.yes) return reading.yes == truth.yes;
  if (truth.number) return reading.number == truth.number;
  if (!truth.area || !reading.point) return false;
  const double x = std::floor(reading.point->x), y = std::floor(reading.point->y);
  if (!(x >= 0 && y >= 0 && x < truth.area->width && y < truth.area->height)) return false;
  return truth.area
      ->mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.area->width) +
             static_cast<std::size_t>(x)];
}

}  // namespace probe::ask
