// What instructions say, apart from how they say it: which differences of words are a paraphrase
// and which ask for something else.
#pragma once

#include <string>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// What Template::Part::words are of a literal.
std::vector<Template::Word> words_of(const std::string& literal);

// The role that an object of this name fills alone in the task, else the name: of the model, or
// `object` itself.
const std::string& role_word(const Model& model, const Task& task, const std::string& object);

// The verb of words on the spot: the first one, whatever its case and the signs around it. Empty
// when a slot stands first.
std::string first_word(const std::vector<Template::Part>& parts);

// An instruction that mentions something it warns against.
bool has_negation(const Template& say);
// The same of any of a task's sentences.
bool has_negation(const Model& model, const Task& task);

// Words of the frame `untold`: a control, which says nothing of its task, or another task's words.
// They are held neither to the scene nor to success, and may be none.
bool is_control(const Template& say);

// Whether two instructions ask for different actions: their verb frames differ, or one says `left`
// where the other says `right`, or the same words stand around other objects ("put A on B", "put B
// on A"), or a sequence goes the other way ("first A, then B", "first B, then A"), or, where
// success is another one, there is a clause more or something more is spoken of ("put A in B", "put
// A in B and close C").
bool asks_otherwise(const Model& model, const Task& a, const Task& b);

// The same of words that are meant for one action: `left` for `right`, other objects, the other way
// round. Frames do not count.
bool contradicts(const Model& model, const Task& a, const Task& b);

// The first word of a folded text that is the opposite of a word of `words`, as in "left" of
// "right"; empty when there is none.
std::string opposite_in(const std::string& text, const std::vector<std::string>& words);

// Whether one of these words is of a pair of opposites.
bool has_opposite(const std::vector<std::string>& words);

// Whether two texts say the same but for words that are opposites in one place: "to the left of the
// plate", "to the right of the plate".
bool are_opposites(std::string_view a, std::string_view b);

// What a template says, word by word, in lower case, without articles and the signs around words;
// a slot is one word: "{source}", "{avoid towel}".
std::vector<std::string> sentence_of(const Template& say);

// Whether two instructions ask for the same in other words, articles aside. A negation brings its
// own words.
bool is_reworded(const Model& model, const Task& a, const Task& b);
// The same of two that are known to ask for the same.
bool has_other_words(const Model& model, const Task& a, const Task& b);

}  // namespace probe::sema
