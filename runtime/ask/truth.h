// The right answer of a question about a picture: as the compiler proved it, or read off the
// picture's segmentation and depth; or why the question is not asked of this picture. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/picture.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// By the question's form one of these is given; of a free answer none, whose rule is mentions.h.
struct Truth {
  std::optional<std::uint32_t> option = {};  // of the question's options
  std::optional<bool> yes = {};
  std::optional<std::int64_t> number = {};
  struct Area {
    int width = 0, height = 0;  // of the picture that is sent
    std::vector<bool> mask;     // raster order
    Reading::Point inside;      // a pixel of it, the nearest to its middle
  };
  std::optional<Area> area = {};
  std::string expected = {};  // in words
  std::string left_out = {};  // why the question is not asked of this picture; else empty
};

// What is right without a look at a picture: as the text proves it, or, of a free answer, what has
// to be mentioned. Nothing where a picture or a judge tells.
std::optional<Truth> known_truth(const plan::Plan& plan, const plan::QuestionRecord& question);

// `view`: what is looked at; `judged`: what the question's program says of the recorded episode or
// the settled start, where its truth is of one.
Truth find_truth(const plan::Plan& plan, const plan::QuestionRecord& question, const View& view,
                 const PictureRule& rule, std::optional<bool> judged = {});

// Of a truth that the picture or the judge told, as a row's `expected` says it; nothing
// where that is neither yes nor no.
std::optional<bool> told_yes(std::string_view expected);

// Whether what was read is the right answer; false where nothing was read. Not of free answers.
bool is_right(const Truth& truth, const Reading& reading);

// Two middles nearer to one another than this share of the picture's width, and two things whose
// depths differ by less, are not asked about.
inline constexpr double kLeastSideways = 0.02;
inline constexpr double kLeastNearer = 0.02;  // m

}  // namespace probe::ask
