// Instructions that must not be trained on, because policies are asked them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace probe::rephrase {

struct Instruction {
  std::string text, task;
};

// All instructions of a suite under the name by which the user called it.
struct Evaluation {
  std::string suite;
  std::vector<Instruction> instructions;
};

struct Leak {
  std::string suite, task, instruction;
  bool is_exact = false;  // else alike by likeness.h
};

class Evaluations {
 public:
  explicit Evaluations(const std::vector<Evaluation>& all);

  // The first instruction that a wording is, an exact one before one that is only alike.
  std::optional<Leak> find(const std::string& wording) const;

 private:
  std::map<std::string, Leak> exact_, alike_;
};

}  // namespace probe::rephrase
