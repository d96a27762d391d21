// What was proven before of rows and traces that have not changed since, so that a million traces
// need not be read again for every report. It lies in the user's cache and never in a run's folder:
// nobody can hand one over. A proof is of a row's bytes and of its file as the system stamps it
// (inode, size, times of content and of change); who changes either has none.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/cache_folder.h"
#include "runtime/plan/plan.h"
#include "runtime/store/results.h"

namespace probe::store {

// A row with its trace file as it is now.
struct ProofKey {
  std::array<std::uint8_t, 16> bytes{};
  bool operator==(const ProofKey&) const = default;
};
// Nothing where the file is not there, or changed so lately that a change after this one could have
// the same stamp.
std::optional<ProofKey> proof_key(const ResultRow& row);

// Keys of many rows, one after the other: the folder of the last trace stays open, since looking up
// a path of many folders is most of what asking for a file costs. For a short while, in one thread.
class ProofKeys {
 public:
  ProofKeys() = default;
  ~ProofKeys();
  ProofKeys(const ProofKeys&) = delete;
  ProofKeys& operator=(const ProofKeys&) = delete;
  std::optional<ProofKey> of(const ResultRow& row);

 private:
  std::string folder_, text_;
  int file_ = -1;
};

class ProofBook {
 public:
  // Fewer rows are read as quickly as looked up.
  static constexpr std::size_t kWorthKeeping = 2000;

  // That of the run in `dir`; without proofs where there is none, or one of another build.
  // `folder` empty: none is kept.
  ProofBook(const std::string& dir, const plan::Plan& plan, const std::string& folder = cache_folder("proofs"));

  // Positions of joints at the end, as add_task() takes them from the trace; null: not proven.
  const std::vector<double>* find(const ProofKey& key) const;
  void add(const ProofKey& key, std::vector<double> joints);
  // Writes what was found or added since the book was opened, if it is worth it; a cache that
  // cannot be written is none.
  void keep();

 private:
  // A million proofs in one table of open places, since each would otherwise be a piece of memory
  // of its own. A key of zeros is no place's: it stands for none.
  struct Place {
    ProofKey key;
    std::uint32_t joints = 0;     // of joints_; 0: none
    mutable bool is_used = false;  // in this process; several threads may look at different places
  };
  Place& place_of(const ProofKey& key);  // of places_, which are not empty
  Place& put(const ProofKey& key, std::vector<double> joints);
  void make_room(std::size_t proofs);

  std::string path_, head_;
  std::vector<Place> places_;  // a power of two of them, at most half taken
  std::size_t taken_ = 0;
  std::vector<std::vector<double>> joints_ = {{}};
  bool has_new_ = false;
};

}  // namespace probe::store
