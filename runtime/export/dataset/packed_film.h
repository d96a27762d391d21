// A film of pictures that are packed one by one: of each camera, frame after frame, bytes of a file
// or a chunk.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/export/dataset/layout.h"

namespace probe::dataset {

struct PackedFilm final : Film {
  std::vector<std::vector<std::string>> cameras;

  void write(ByteWriter& bytes) const override {
    for (const std::vector<std::string>& camera : cameras) {
      bytes.u32(static_cast<std::uint32_t>(camera.size()));
      for (const std::string& frame : camera) bytes.text(frame);
    }
  }
  // Null where these are no bytes of a film of so many cameras.
  static std::unique_ptr<Film> read(ByteReader& bytes, std::size_t cameras) {
    auto film = std::make_unique<PackedFilm>();
    film->cameras.resize(cameras);
    for (std::vector<std::string>& camera : film->cameras) {
      camera.resize(bytes.count(bytes.u32(), sizeof(std::uint32_t)));
      for (std::string& frame : camera) frame = bytes.text();
    }
    if (!bytes.ok()) return nullptr;
    return film;
  }
};

}  // namespace probe::dataset
