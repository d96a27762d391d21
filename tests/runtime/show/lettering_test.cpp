// Words in pictures, with the fonts of this machine: DejaVu Sans is among what the build installs.
#include "runtime/show/lettering.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "runtime/show/overlay.h"

namespace probe::show {
namespace {

Lettering& letters() {
  const auto shared = Lettering::shared();
  REQUIRE_MESSAGE(shared.ok(), (shared.ok() ? "" : to_text(shared.failure())));
  return **shared;
}

Picture written(std::string_view text, int size = 20) {
  Picture picture = make_picture(240, 40, {0, 0, 0});
  letters().draw(picture, 2, 2, text, {255, 255, 255}, size);
  return picture;
}

std::ptrdiff_t inked(const Picture& picture) {
  return std::count_if(picture.rgb.begin(), picture.rgb.end(),
                       [](std::uint8_t byte) { return byte > 127; });
}

TEST_CASE("text is drawn with the letters' pixels and clipped where the picture ends") {
  const Picture letter = written("I");
  CHECK(inked(letter) > 3 * 14);  // a stem
  int left = 240, right = -1, top = 40, bottom = -1;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 240; ++x) {
      if (letter.rgb[static_cast<std::size_t>(3 * (y * 240 + x))] < 128) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  CHECK(left >= 2);
  CHECK(right - left < 5);
  CHECK(top >= 2);
  CHECK(bottom == 2 + 20 - 1);  // it stands on the base line
  CHECK(bottom - top > 11);
  CHECK(inked(written("II")) == 2 * inked(letter));
  Picture corner = make_picture(40, 10, {0, 0, 0});
  letters().draw(corner, 38, 4, "over the edge", {9, 9, 9}, 30);
  letters().draw(corner, -300, -4, "before the edge", {9, 9, 9}, 30);
  CHECK(corner.rgb.size() == 3 * 40 * 10);
}

TEST_CASE("a line is cut between characters where the room ends") {
  const std::string words = "put the carrot on the plate";
  const int whole = letters().width(words, 20);
  CHECK(letters().fit(words, whole, 20) == words);
  const std::string cut = letters().fit(words, whole - 1, 20);
  CHECK(cut.ends_with(".."));
  CHECK(words.starts_with(cut.substr(0, cut.size() - 2)));
  CHECK(letters().width(cut, 20) < whole);
  CHECK(letters().fit(words, 3, 20).empty());
  for (int room = 10; room < 100; room += 3) {  // never half of a character
    const std::string umlauts =
        letters().fit("\u00fc\u00fc\u00fc\u00fc\u00fc\u00fc\u00fc\u00fc", room, 20);
    const std::size_t dots = umlauts.ends_with("..") ? 2 : 0;
    CHECK((umlauts.size() - dots) % 2 == 0);
  }
}

TEST_CASE("scripts of the fonts at hand are read: accents, Greek, Cyrillic, letters that join") {
  const Picture box = written("\U0010fffd");  // no font has it
  CHECK(inked(box) > 0);
  for (const char* word : {"\u00e9", "\u03bb", "\u0416", "\u0634"}) {
    CAPTURE(word);
    CHECK(inked(written(word)) > 0);
    CHECK(written(word).rgb != box.rgb);
  }
  // Arabic is set from right to left, and a letter takes another shape among its neighbours.
  const int alone = letters().width("\u0628", 40);
  CHECK(letters().width("\u0628\u0628\u0628", 40) < 3 * alone - 4);
  CHECK(written("\u0627\u0628").rgb != written("\u0628\u0627").rgb);
}

TEST_CASE("what is no text is drawn as something, never past the picture or the line") {
  CHECK(inked(written("a\xff\xfe")) > inked(written("a")));
  CHECK(written("a\tb\n").rgb == written("a b ").rgb);
  CHECK(inked(written("")) == 0);
}

TEST_CASE("without a font there is no lettering, and the failure says what to install") {
  const auto none = Lettering::open({});
  REQUIRE_FALSE(none.ok());
  CHECK(none.failure().code == Fault::kVideo);
  CHECK(none.failure().message.find("fonts-dejavu-core") != std::string::npos);
  const auto other = Lettering::open({{VLAPROBE_SOURCE_DIR "/README.md", 0}});
  REQUIRE_FALSE(other.ok());
  CHECK(other.failure().where == VLAPROBE_SOURCE_DIR "/README.md");
}

TEST_CASE("a font that was asked for and is none is refused by name, whatever else there is") {
  std::vector<FontFile> files = installed_fonts();
  REQUIRE_FALSE(files.empty());
  files.insert(files.begin(), FontFile{VLAPROBE_SOURCE_DIR "/README.md", 0, true});
  const auto no_font = Lettering::open(files);
  REQUIRE_FALSE(no_font.ok());
  CHECK(no_font.failure().code == Fault::kVideo);
  CHECK(no_font.failure().message == "VLAPROBE_FONT names a file that is no font");
  CHECK(no_font.failure().where == VLAPROBE_SOURCE_DIR "/README.md");
  files.front().path = "/nowhere/at/all.ttf";
  const auto no_file = Lettering::open(files);
  REQUIRE_FALSE(no_file.ok());
  CHECK(no_file.failure().message == "VLAPROBE_FONT names no file");
  // One that the machine lists and nobody asked for is only left out.
  files.front().asked_for = false;
  CHECK(Lettering::open(files).ok());
}

TEST_CASE("with VLAPROBE_FONT set its file comes first and is known as asked for") {
  const std::string font = installed_fonts().front().path;
  ::setenv("VLAPROBE_FONT", font.c_str(), 1);
  const std::vector<FontFile> files = installed_fonts();
  ::unsetenv("VLAPROBE_FONT");
  REQUIRE_FALSE(files.empty());
  CHECK(files.front().asked_for);
  CHECK(files.front().path == font);
  CHECK(std::count_if(files.begin(), files.end(), [](const FontFile& f) { return f.asked_for; }) ==
        1);
}

TEST_CASE("the strips of a video say instruction, step and verdicts, and leave the middle alone") {
  const Picture blank = make_picture(640, 480, {100, 100, 100});
  Picture frame = blank;
  const store::MetricValue metrics[] = {{"success", true, 1}, {"grasp", true, 0}};
  draw_overlay(frame, {"put the carrot on the plate", "task", 3, 60, metrics}, letters());
  const auto rows_changed = [&](int from, int to) {
    int changed = 0;
    for (int y = from; y < to; ++y) {
      const auto at = static_cast<std::ptrdiff_t>(3 * 640 * y);
      changed += std::equal(frame.rgb.begin() + at, frame.rgb.begin() + at + 3 * 640,
                            blank.rgb.begin() + at)
                     ? 0
                     : 1;
    }
    return changed;
  };
  CHECK(rows_changed(0, 40) == 40);
  CHECK(rows_changed(60, 440) == 0);
  CHECK(rows_changed(455, 480) == 25);
}

}  // namespace
}  // namespace probe::show
