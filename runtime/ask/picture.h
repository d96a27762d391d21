// What is looked at: the picture that a policy gets at a start, or at the end of a recorded
// episode, with its depth and segmentation; and the file that is sent of it. Knows no questions.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/servers/profile.h"
#include "runtime/stage/stage.h"
#include "runtime/store/trace.h"

namespace probe::ask {

// Which picture is sent, and in which size.
struct PictureRule {
  std::string camera;         // empty: the task's first
  int width = 0, height = 0;  // 0: as the camera has it
  servers::Resize resize = servers::Resize::kStretch;
};

// What a camera saw, raster order, row 0 on top; see render::FrameView.
struct View {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::uint16_t> segmentation;
};

struct SentPicture {
  int width = 0, height = 0;
  std::string png;     // the file
  std::string sha256;  // of its bytes, hex
  // "data:image/png;base64,...", made once for all that is asked about it; empty: nobody is sent
  // it.
  std::string data_uri = {};
};

// Makes views; one thread's. Two tasks are kept at a time, as the prior arm goes back and forth.
class Viewer {
 public:
  // `plan` and `rule` live as long; the assets are those of every task that is looked at.
  Viewer(const plan::Plan& plan, std::shared_ptr<const stage::SharedAssets> assets,
         const PictureRule& rule)
      : plan_(plan), assets_(std::move(assets)), rule_(rule) {}

  // As a policy sees it before its first action. Fails (kUsage) on a camera that the task lacks,
  // and as Stage does.
  Result<View> start(std::uint32_t episode);
  // The question's program where things have come to rest in the start that was last looked at,
  // which is of its task. Fails (kJudge) as a judge does.
  Result<bool> judge_start(const plan::QuestionRecord& question) const;
  // After the last action of the trace, done again step by step. Fails (kTrace) when the world
  // does not end where the trace says, bit for bit: then this machine's picture would not be the
  // recorded one's.
  Result<View> end(std::uint32_t episode, const store::Trace& trace);

 private:
  Result<stage::Stage*> stage_of(std::uint32_t task);
  Result<View> look(stage::Stage& stage);

  const plan::Plan& plan_;
  std::shared_ptr<const stage::SharedAssets> assets_;
  const PictureRule& rule_;
  std::list<std::unique_ptr<stage::Stage>> stages_;  // the last used first
};

// A PNG file as chat servers take it: "data:image/png;base64,...".
std::string data_uri_of(std::string_view png);

// In the size that is sent.
std::pair<int, int> sent_size(const View& view, const PictureRule& rule);
Result<SentPicture> to_sent(const View& view, const PictureRule& rule);
// The depth and the bodies of what is sent, before it is resized: all of the view, unless the rule
// crops it. Without colours.
View sent_part(const View& view, const PictureRule& rule);
// Which pixels of the picture that is sent show `body`: at least half of each, by the very
// function that makes the picture's size.
std::vector<bool> sent_mask(const View& view, const PictureRule& rule, std::uint32_t body);

}  // namespace probe::ask
