// What a format has to say: pictures are made into its files' bytes by many threads at once, and
// put into the files by one, in the order of the episodes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/base/bytes.h"
#include "runtime/base/result.h"
#include "runtime/export/dataset/demonstration.h"

namespace probe::dataset {

// A demonstration's pictures, in a format's own form.
class Film {
 public:
  virtual ~Film() = default;
  // As Layout::film_of reads it back, so that an export that was killed does not make it again.
  virtual void write(ByteWriter& bytes) const = 0;
};

// Takes the pictures of one demonstration, step by step, every camera's in the shape's order.
class FilmMaker {
 public:
  virtual ~FilmMaker() = default;
  virtual Status add(std::span<const Picture> pictures) = 0;
  virtual Result<std::unique_ptr<Film>> finish() = 0;
};

// What is told of a dataset when it is whole.
struct Contents {
  std::int64_t demonstrations = 0, episodes = 0, frames = 0;
  std::string readme;     // what README.md says of the format
  std::string card = {};  // and what stands before all of it, for programs
};

class Layout {
 public:
  virtual ~Layout() = default;
  // Of any thread, for `steps` steps.
  virtual Result<std::unique_ptr<FilmMaker>> film(std::size_t steps) const = 0;
  // What Film::write of a film of this layout wrote; null where it is none.
  virtual std::unique_ptr<Film> film_of(ByteReader& bytes) const = 0;
  // Why the format cannot have it; such a demonstration is left out, and that is told.
  virtual std::optional<std::string> refusal(const Demonstration& /*demonstration*/) const {
    return std::nullopt;
  }
  // Of one thread at a time, in order; `film` is what a maker of this layout has finished.
  virtual Status add(const Demonstration& demonstration, std::unique_ptr<Film> film) = 0;
  virtual Result<Contents> finish() = 0;
};

}  // namespace probe::dataset
