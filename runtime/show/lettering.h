// Words as pixels, in every script for which the machine has a font: fontconfig finds the files,
// raqm (HarfBuzz, FriBidi) sets the letters, FreeType draws them. Only lettering.cpp knows of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/show/picture.h"

namespace probe::show {

struct FontFile {
  std::string path;
  int face = 0;            // of the several in one file
  bool asked_for = false;  // by VLAPROBE_FONT: if it is no font, that is a failure
};

// Scalable fonts, the best for a caption first; each adds characters that those before lack. Empty
// where none is installed. `VLAPROBE_FONT`, a file, comes before all others.
std::vector<FontFile> installed_fonts();

// Sizes are the pixels of an em. A character that no font has is drawn as the first font's box.
class Lettering {
 public:
  // Fails (kVideo) when none of the files is a font, saying what to install, and naming one that
  // was asked for and is none.
  static Result<std::unique_ptr<Lettering>> open(const std::vector<FontFile>& files);
  // Of the installed fonts, made at the first call; any thread may use it.
  static Result<Lettering*> shared();
  ~Lettering();

  // Pixels from the first letter's left to the last one's right.
  int width(std::string_view text, int size);
  // `y` is the upper edge of a line, which is line_height(size) high. Clipped to the picture.
  void draw(Picture& picture, int x, int y, std::string_view text,
            std::array<std::uint8_t, 3> color, int size);
  // The longest beginning that fits, with ".." where something was left out.
  std::string fit(std::string_view text, int width, int size);

 private:
  class Faces;
  explicit Lettering(std::unique_ptr<Faces> faces);
  std::mutex mutex_;  // a font draws one letter at a time
  std::unique_ptr<Faces> faces_;
};

inline constexpr int kSmallText = 10;

// Room for ascenders, descenders and accents.
constexpr int line_height(int size) { return size + (size + 3) / 4; }

}  // namespace probe::show
