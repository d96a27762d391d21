// Which objects a question speaks of, and whether its words leave open which is meant: objects are
// told apart by what they are called, and two of one name, or a plate beside a small plate, are
// not.
#pragma once

#include <string>
#include <vector>

#include "compiler/define/family_of_task.h"

namespace probe::sema {

class Referents {
 public:
  // `bound`: what the family's `for` binds.
  Referents(const FamilyOfTask& asked, ObjectId bound)
      : asked_(asked),
        model_(asked.model()),
        scene_(asked.scene),
        set_(asked.set()),
        family_(asked.family()),
        task_(asked.task()),
        objects_(asked.objects()),
        bound_(bound) {}

  // Who is meant in this task.
  MayOmit resolve(const Who& who, ObjectId& out) const;
  // The same of parts and regions of fixtures, too.
  MayOmit resolve_any(const Who& who, ObjectId& out) const;
  // The same for what has to be in the scene.
  MayOmit resolve_there(const Who& who, ObjectId& out) const;

  // Whether the instruction speaks of what fills another role than source and target: then these
  // two are not all that it asks for.
  bool asks_for_more() const;

  // Reports that a question has no single right answer.
  plan::OmissionReason ambiguous(const Span& span, const std::string& message) const;

  // Each says why not, where the words could be taken for another object of the scene.
  MayOmit check_name_of(ObjectId id, const Span& span) const;
  MayOmit check_phrase_of(const Phrase& phrase, ObjectId id, const Span& span) const;
  // That the instruction asks for this object and for no other.
  MayOmit check_role(const Who& who, ObjectId id) const;
  // What is described by an attribute is described alone.
  MayOmit check_attributes(ObjectId right) const;
  // That no two are called the same.
  MayOmit check_options(const std::vector<ObjectId>& options) const;

 private:
  MayOmit check_looks_of(ObjectId id, const std::string& words, const Span& span) const;
  MayOmit check_places_of(const Phrase& phrase, ObjectId id, const Span& span) const;
  MayOmit check_told(ObjectId id, const Span& span) const;
  std::string here() const { return asked_.here(); }

  const FamilyOfTask& asked_;
  const Model& model_;
  const SceneObjects& scene_;
  const QuestionSet& set_;
  const Family& family_;
  const Task& task_;
  const std::vector<ObjectId>& objects_;
  ObjectId bound_;
};

}  // namespace probe::sema
