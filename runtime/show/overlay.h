// The strips of instruction, step and metrics that videos carry. Never used on a picture that a
// policy sees.
#pragma once

#include <span>
#include <string_view>

#include "runtime/show/lettering.h"
#include "runtime/show/picture.h"
#include "runtime/store/results.h"

namespace probe::show {

struct OverlayText {
  std::string_view instruction;
  std::string_view caption;  // task, episode, seed, policy
  int step = 0, horizon = 0;
  std::span<const store::MetricValue> metrics;
};
// A dark strip on top (instruction) and below (step, metrics: filled marks are true).
void draw_overlay(Picture& picture, const OverlayText& text, Lettering& lettering);

}  // namespace probe::show
