// Golden pictures as files, and what a comparison with them says. The same libraries, compiler and
// CPU family must give the same bytes; elsewhere small differences are allowed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/doctor/golden_scenes.h"
#include "runtime/store/fingerprint.h"

namespace probe::doctor {

// `golden_frames` of the tests of the source tree the program was built from; empty if not there.
std::string golden_folder();
// Whether these are the assets that the golden pictures show: the manifest is that source tree's.
bool shown_in_golden(const std::string& folder);
// The texts whose scenes' first frames are among them, of the same source tree; none if not there.
std::vector<std::string> golden_suites();

enum class GoldenState : std::uint8_t {
  kIdentical,  // byte for byte
  kClose,      // within the tolerance, and made by other libraries, compiler or CPU
  kDiffers,
  kMissing  // not stored
};
const char* to_text(GoldenState state);

struct GoldenCheck {
  std::string name;
  GoldenState state = GoldenState::kMissing;
  int ids = 0;       // pixels that show another thing
  int levels = 0;    // pixels whose colour differs by more than 2 of 255
  double depth = 0;  // m, the largest difference where ids agree
};

struct GoldenReport {
  std::vector<GoldenCheck> frames;
  GoldenState settle = GoldenState::kMissing;
  double settle_distance = 0;            // m, the largest of the settled objects
  std::vector<std::string> other_build;  // what differs from the build that made the stored ones
  bool fine() const;
};

// What the bits of a picture depend on besides our own code: compiler, CPU family, libraries.
store::Fingerprint picture_fingerprint();

// One PNG a frame (colours, below them depth in micrometres as 24 bits, below them ids) and
// golden.json with hashes and the fingerprint.
Status write_golden(const std::string& folder, std::span<const GoldenFrame> frames,
                    const GoldenSettle& settle);
// Fails on a folder that cannot be read; a frame that is not there is kMissing.
Result<GoldenReport> check_golden(const std::string& folder, std::span<const GoldenFrame> frames,
                                  const GoldenSettle& settle);

// Writes golden, present and four times their difference below each other, for people.
Status write_golden_difference(const std::string& folder, const GoldenFrame& frame,
                               const std::string& png);

}  // namespace probe::doctor
