// The videos of a dataset against the pictures that the policy saw. Video is lossy: what is held
// against a picture is how far it is from it, and that where things move it is not a step late or
// early.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/export/dataset/findings.h"
#include "runtime/show/clip.h"

namespace probe::dataset {

// The largest root mean square of differences, over pixels and colours, of 255. Of what x264 makes
// at constant rate factor 20 of our scenes it is 1.8 to 4.3 (4,702 frames of 128 x 128 to 640 x
// 480).
inline constexpr double kMostVideoError = 8;

// Where a demonstration's pictures of one camera are.
struct VideoStretch {
  std::string path;        // of the file
  std::int64_t begin = 0;  // its first frame's number in it
};

class VideoCheck {
 public:
  explicit VideoCheck(PicturesAgain& again) : again_(again) {}

  // `stretches`: one a camera, behind those of the demonstration before. What is wrong is told in
  // `findings`, of a file that cannot be read once.
  void check(Findings& findings, const NamedDemonstration& named,
             const std::vector<VideoStretch>& stretches, const std::string& where);

 private:
  struct Film {
    std::string path;
    std::unique_ptr<show::ClipReader> reader;  // null: cannot be read
    std::int64_t next = 0;                     // the number of the frame that it gives next
  };
  // So that the film's next frame is the stretch's first; false where that cannot be.
  bool go_to(Findings& findings, Film& film, const VideoStretch& stretch);

  PicturesAgain& again_;
  std::vector<Film> films_;  // one a camera
};

}  // namespace probe::dataset
