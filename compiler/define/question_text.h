// The words of a question about one task: placeholders filled with what the task's objects are
// called.
#pragma once

#include <string>
#include <vector>

#include "compiler/define/referents.h"

namespace probe::sema {

class QuestionText {
 public:
  QuestionText(const FamilyOfTask& asked, const Referents& referents)
      : asked_(asked), referents_(referents) {}

  // Once. Why not, where the task has not what a placeholder wants, or it leaves open what is
  // meant.
  MayOmit render();

  const std::string& text() const { return text_; }
  const std::string& own() const { return own_; }                        // without the instruction
  const std::vector<ObjectId>& mentioned() const { return mentioned_; }  // by name

 private:
  MayOmit say(const Placeholder& placeholder, std::string& out);

  const FamilyOfTask& asked_;
  const Referents& referents_;
  std::string text_, own_;
  std::vector<ObjectId> mentioned_;
};

}  // namespace probe::sema
