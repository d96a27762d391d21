// What makes a reading doubtful although a rule gave it: denials behind what was chosen, words that
// take it back, hedges, contradictions. A doubtful reading is unclear.
#pragma once

#include "runtime/ask/reading/read_places.h"
#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {

// Whether what `reading` (of that rule, verdict kRead) takes from the part is denied, hedged, taken
// back or contradicted in it. Linear in the part.
bool is_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                 const Reading& reading);

// Whether the sentence of a part's mark speaks against what was read from the part; before the mark
// of a line stand plain words alone.
bool is_denied_before(const ReadContext& context, const AnswerPart& whole, const FoundPart& part,
                      const Place& place, const Reading& reading);
// Whether what follows byte `from` does.
bool is_denied_behind(const ReadContext& context, const AnswerPart& whole, std::size_t from,
                      const Reading& reading);

// What is_doubtful asks by the question's form; signs that strike out are looked for before.
bool is_choice_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                        const Reading& reading);
bool is_yesno_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                       const Reading& reading);
bool is_number_doubtful(const ReadContext& context, const AnswerPart& part, const Reading& reading);
bool is_point_doubtful(const ReadContext& context, const AnswerPart& part, const Reading& reading);

// Where the sentence begins that the token `at` stands in.
std::size_t begin_of_sentence(const Tokens& tokens, std::size_t at);

// Whether the question asks if something is there: its words, "is there", "visible".
bool asks_for_presence(const ReadContext& context);

}  // namespace probe::ask
