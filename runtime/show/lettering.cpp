#include "runtime/show/lettering.h"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include <raqm.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "runtime/base/own_folder.h"
#include "runtime/base/paths.h"
#include "runtime/base/utf8.h"
#include FT_FREETYPE_H

namespace probe::show {
namespace {

template <typename T, void (*release)(T*)>
struct Releaser {
  void operator()(T* value) const { release(value); }
};
void free_face(FT_FaceRec_* face) { FT_Done_Face(face); }
void free_library(FT_LibraryRec_* library) { FT_Done_FreeType(library); }
using Face = std::unique_ptr<FT_FaceRec_, Releaser<FT_FaceRec_, free_face>>;
using Library = std::unique_ptr<FT_LibraryRec_, Releaser<FT_LibraryRec_, free_library>>;
using Paragraph = std::unique_ptr<raqm_t, Releaser<raqm_t, raqm_destroy>>;
using FontSet = std::unique_ptr<FcFontSet, Releaser<FcFontSet, FcFontSetDestroy>>;
using Pattern = std::unique_ptr<FcPattern, Releaser<FcPattern, FcPatternDestroy>>;

// What cannot be read shows as what stands for it; what would move the line is a space.
std::vector<std::uint32_t> characters(std::string_view text) {
  std::vector<std::uint32_t> out;
  while (!text.empty()) {
    const Utf8Char next = first_utf8(text);
    out.push_back(is_control(next.code) ? U' ' : next.code);
    text.remove_prefix(std::max<std::size_t>(1, next.bytes));
  }
  return out;
}

void blend(Picture& picture, int x, int y, const std::array<std::uint8_t, 3>& color, int cover) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  std::uint8_t* pixel = picture.rgb.data() +
                        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(x));
  for (std::size_t k = 0; k < 3; ++k) {
    pixel[k] = static_cast<std::uint8_t>((pixel[k] * (255 - cover) + color[k] * cover + 127) / 255);
  }
}

}  // namespace

class Lettering::Faces {
 public:
  static Result<std::unique_ptr<Faces>> open(const std::vector<FontFile>& files) {
    auto faces = std::make_unique<Faces>();
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0) {
      return Failure{Fault::kVideo, "FreeType does not start", ""};
    }
    faces->library_.reset(library);
    for (const FontFile& file : files) {
      FT_Face face = nullptr;
      const bool is_font = FT_New_Face(library, file.path.c_str(), file.face, &face) == 0;
      if (is_font && FT_IS_SCALABLE(face)) {
        faces->faces_.emplace_back(face);
        continue;
      }
      if (is_font) FT_Done_Face(face);
      if (!file.asked_for) continue;  // one of many that the machine has
      if (!is_file(file.path)) {
        return Failure{Fault::kVideo, "VLAPROBE_FONT names no file", file.path};
      }
      return Failure{Fault::kVideo,
                     is_font ? "VLAPROBE_FONT names a font of pixels; words need one that scales"
                             : "VLAPROBE_FONT names a file that is no font",
                     file.path};
    }
    if (!faces->faces_.empty()) return faces;
    return Failure{Fault::kVideo,
                   "no font to write words with: install fonts-dejavu-core or another, or name a "
                   "file in VLAPROBE_FONT",
                   files.empty() ? "" : files.front().path};
  }

  struct Glyph {
    FT_Face face = nullptr;
    unsigned index = 0;
    int x = 0, y = 0;  // of the origin, 64ths of a pixel, y down
  };
  struct Line {
    std::vector<Glyph> glyphs;
    int width = 0;  // 64ths of a pixel
  };

  Line lay_out(std::string_view text, int size) {
    const std::vector<std::uint32_t> words = characters(text);
    Line line;
    const Paragraph paragraph(raqm_create());
    if (words.empty() || !paragraph ||
        !raqm_set_text(paragraph.get(), words.data(), words.size())) {
      return line;
    }
    for (const Face& face : faces_) FT_Set_Pixel_Sizes(face.get(), 0, static_cast<unsigned>(size));
    raqm_set_par_direction(paragraph.get(), RAQM_DIRECTION_DEFAULT);
    // Neighbours of one font are set together: letters join, accents find their letter.
    for (std::size_t first = 0; first < words.size();) {
      FT_Face face = face_of(words[first], nullptr);
      std::size_t end = first + 1;
      while (end < words.size() && face_of(words[end], face) == face) ++end;
      raqm_set_freetype_face_range(paragraph.get(), face, first, end - first);
      first = end;
    }
    if (!raqm_layout(paragraph.get())) return line;
    std::size_t count = 0;
    const raqm_glyph_t* glyphs = raqm_get_glyphs(paragraph.get(), &count);
    for (std::size_t i = 0; i < count; ++i) {
      const raqm_glyph_t& glyph = glyphs[i];
      line.glyphs.push_back({glyph.ftface, glyph.index,
                             line.width + static_cast<int>(glyph.x_offset),
                             -static_cast<int>(glyph.y_offset)});
      line.width += static_cast<int>(glyph.x_advance);
    }
    return line;
  }

 private:
  // The one before if it has the character, too: a space or a digit belongs to any script.
  FT_Face face_of(std::uint32_t character, FT_Face before) const {
    if (before != nullptr && FT_Get_Char_Index(before, character) != 0) return before;
    for (const Face& face : faces_) {
      if (FT_Get_Char_Index(face.get(), character) != 0) return face.get();
    }
    return faces_.front().get();
  }

  Library library_;  // outlives its faces
  std::vector<Face> faces_;
};

std::vector<FontFile> installed_fonts() {
  std::vector<FontFile> files;
  if (const char* named = std::getenv("VLAPROBE_FONT"); named != nullptr && *named != '\0') {
    files.push_back({.path = named, .face = 0, .asked_for = true});
  }
  // A bundle brings the letters that it was tested with; where the system has no fonts, it has nothing to say either.
  for (const std::filesystem::path& own : own_places("fonts/DejaVuSans.ttf")) {
    std::error_code error;
    if (std::filesystem::is_regular_file(own, error)) files.push_back({.path = own.string(), .face = 0});
    if (!files.empty() && !std::filesystem::exists("/etc/fonts/fonts.conf", error)) return files;
  }
  const Pattern wanted(FcNameParse(reinterpret_cast<const FcChar8*>("DejaVu Sans")));
  if (!wanted) return files;
  FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultMatch;
  const FontSet fonts(FcFontSort(nullptr, wanted.get(), FcTrue, nullptr, &result));
  for (int i = 0; fonts && i < fonts->nfont; ++i) {
    FcChar8* path = nullptr;
    int face = 0;
    FcBool scalable = FcFalse;
    FcPatternGetBool(fonts->fonts[i], FC_SCALABLE, 0, &scalable);
    if (scalable == FcFalse ||
        FcPatternGetString(fonts->fonts[i], FC_FILE, 0, &path) != FcResultMatch) {
      continue;
    }
    FcPatternGetInteger(fonts->fonts[i], FC_INDEX, 0, &face);
    files.push_back({.path = reinterpret_cast<const char*>(path), .face = face});
  }
  return files;
}

Lettering::Lettering(std::unique_ptr<Faces> faces) : faces_(std::move(faces)) {}
Lettering::~Lettering() = default;

Result<std::unique_ptr<Lettering>> Lettering::open(const std::vector<FontFile>& files) {
  PROBE_ASSIGN(auto faces, Faces::open(files));
  return std::unique_ptr<Lettering>(new Lettering(std::move(faces)));
}

Result<Lettering*> Lettering::shared() {
  static const Result<std::unique_ptr<Lettering>> kOpened = open(installed_fonts());
  if (!kOpened) return kOpened.failure();
  return kOpened->get();
}

int Lettering::width(std::string_view text, int size) {
  const std::scoped_lock lock(mutex_);
  return (faces_->lay_out(text, size).width + 63) / 64;
}

void Lettering::draw(Picture& picture, int x, int y, std::string_view text,
                     std::array<std::uint8_t, 3> color, int size) {
  const std::scoped_lock lock(mutex_);
  // A line's letters stand a quarter of it above its lower edge.
  const int baseline = y + size;
  for (const Faces::Glyph& glyph : faces_->lay_out(text, size).glyphs) {
    if (FT_Load_Glyph(glyph.face, glyph.index, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0)
      continue;
    const FT_GlyphSlot slot = glyph.face->glyph;
    const FT_Bitmap& ink = slot->bitmap;
    if (ink.pixel_mode != FT_PIXEL_MODE_GRAY) continue;
    const int left = x + (glyph.x + 32) / 64 + slot->bitmap_left;
    const int top = baseline + glyph.y / 64 - slot->bitmap_top;
    for (unsigned row = 0; row < ink.rows; ++row) {
      for (unsigned column = 0; column < ink.width; ++column) {
        const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(ink.pitch);
        blend(picture, left + static_cast<int>(column), top + static_cast<int>(row), color,
              ink.buffer[at + column]);
      }
    }
  }
}

std::string Lettering::fit(std::string_view text, int width, int size) {
  if (this->width(text, size) <= width) return std::string(text);
  std::vector<std::size_t> ends{0};
  for (std::size_t at = 0; at < text.size();) {
    at += std::max<std::size_t>(1, first_utf8(text.substr(at)).bytes);
    ends.push_back(at);
  }
  const auto cut = [&](std::size_t characters) {
    return std::string(text.substr(0, ends[characters])) + "..";
  };
  std::size_t fits = 0, too_many = ends.size();
  while (fits + 1 < too_many) {
    const std::size_t middle = (fits + too_many) / 2;
    (this->width(cut(middle), size) <= width ? fits : too_many) = middle;
  }
  const std::string shortest = cut(fits);
  return this->width(shortest, size) <= width ? shortest : std::string();
}

}  // namespace probe::show
