// One defect a rule of questions, made on the plan of question_plan.h.
#pragma once

#include "tests/plan/defects.h"
#include "tests/runtime/plan/question_plan.h"

namespace probe::plan {

inline std::vector<Defect> question_defects() {
  return {
      {"QFAM", "form 9", [](Records& r, Writer&) { r.families[0].form = 9; }},
      {"QFAM", "moment 0", [](Records& r, Writer&) { r.families[0].moment = 0; }},
      {"QUES", "truth 77", [](Records& r, Writer&) { r.questions[0].truth = 77; }},
      {"QOUT", "reason 99", [](Records& r, Writer&) { r.omissions[0].reason = 99; }},
      {"QFAM", "zero", [](Records& r, Writer&) { r.families[1].zero = 1; }},
      {"QUES", "QFAM", [](Records& r, Writer&) { r.questions[0].family = 60; }},
      {"QUES", "TASK", [](Records& r, Writer&) { r.questions[0].task = 60; }},
      {"QOPT", "flags 0x6", [](Records& r, Writer&) { r.options[0].flags = 6; }},
      {"QOPT", "need not be seen", [](Records& r, Writer&) { r.options[2].flags = kMustBeSeen; }},
      {"QOPT", "body 2 of task `carrot_on_plate` is no object",
       [](Records& r, Writer&) { r.options[1].body = 2; }},
      {"QFAM", "are called `which`",
       [](Records& r, Writer&) { r.families[1].name = r.families[0].name; }},
      {"QUES", "questions ascend",
       [](Records& r, Writer&) { r.questions[0].family = 1, r.questions[1].family = 0; }},
      {"QOUT", "omissions ascend", [](Records& r, Writer&) { r.omissions[1] = r.omissions[0]; }},
      {"QUES", "must begin at record 3",
       [](Records& r, Writer&) { r.questions[1].options.first = 1; }},
      {"QOPT", "an option belongs to a question",
       [](Records& r, Writer&) { r.options.push_back(r.options[1]); }},
      {"QOPT", "must begin at record 1", [](Records& r, Writer&) { r.options[2].words.first = 0; }},
      {"QWRD", "a word belongs to an option",
       [](Records& r, Writer&) { r.words.push_back(r.words[0]); }},
      {"QUES", "a question has 1 options",
       [](Records& r, Writer&) {
         r.questions[0].options.count = 1;
         for (std::size_t i = 1; i < r.questions.size(); ++i) r.questions[i].options.first -= 2;
         r.options.erase(r.options.begin() + 1, r.options.begin() + 3);
         r.words.erase(r.words.begin() + 1);
         for (std::size_t i = 1; i < r.options.size(); ++i) {
           if (r.options[i].words.count > 0) --r.options[i].words.first;
         }
       }},
      {"QUES", "`plate` stands for two options",
       [](Records& r, Writer&) { r.words[0] = r.options[1].text; }},
      {"QUES", "`orange thing` stands for two options",
       [](Records& r, Writer&) { r.words[1] = r.words[0]; }},
      // Tied to other tasks, or to other answers.
      {"QOPT", "is called \"carrot\" in task",
       [](Records& r, Writer& w) { r.options[0].text = w.text("tomato"); }},
      {"QOPT", "`carrot` is an object of task",
       [](Records& r, Writer& w) { r.options.back().text = w.text("carrot"); }},
      {"QUES", "1 is no answer about what is not there",
       [](Records& r, Writer&) { r.questions.back().right = 1; }},
      {"QUES", "0 is no answer about what is there",
       [](Records& r, Writer& w) {
         r.options.back().text = w.text("carrot");
         r.options.back().body = 0;
       }},
      {"QUES", "it asks for 2 objects",
       [](Records& r, Writer& w) {
         r.options.push_back(r.options.back());
         r.options.back().text = w.text("tomato");
         r.questions.back().options.count = 2;
       }},
      {"QUES", "3 is no right answer", [](Records& r, Writer&) { r.questions[0].right = 3; }},
      {"QUES", "0 is no right answer", [](Records& r, Writer&) { r.questions[1].right = 0; }},
      {"QUES", "cannot have truth 4", [](Records& r, Writer&) { r.questions[0].truth = 4; }},
      {"QUES", "cannot have truth 5", [](Records& r, Writer&) { r.families[5].moment = 1; }},
      {"QUES", "is about 2 objects", [](Records& r, Writer&) { r.questions[1].b = 0; }},
      {"QUES", "is about 1 objects", [](Records& r, Writer&) { r.questions[3].a = kNone; }},
      {"QUES", "a program with one truth", [](Records& r, Writer&) { r.questions[5].program = 0; }},
      {"QUES", "a program with one truth", [](Records& r, Writer&) { r.questions[0].program = 1; }},
      {"QUES", "question id", [](Records& r, Writer&) { r.questions[0].question_id[0] ^= 1; }},
  };
}

}  // namespace probe::plan
