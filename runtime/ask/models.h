// Who answers: the table of models behind --model. A server of the chat interface, and three in
// this process that look at nothing: floors and a ceiling, which speak in words as a server does,
// so that what reads answers reads theirs too.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/ask_record.h"
#include "runtime/ask/reading/likely_letters.h"
#include "runtime/ask/picture.h"
#include "runtime/ask/truth.h"
#include "runtime/ask/wording.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// A query as a model gets it. What it refers to lives until the answer.
struct AskedQuery {
  const plan::Plan& plan;
  const plan::QuestionRecord& question;
  const Wording& wording;
  const Truth& truth;          // for the model that knows it
  const SentPicture* picture;  // null: none is shown
  int width = 0, height = 0;   // of the picture, shown or not
  Sha256 draw = {};            // of the query's key, for the model that draws
  Arm arm = Arm::kPicture;
  std::uint32_t rotation = 0;
  int episode = 0;  // of the task
};

struct Said {
  std::string raw, reasoning = {};
  Usage usage = {};
  bool has_logprobs = false;                // the server tells some
  std::vector<WrittenLetter> letters = {};  // of them those where a letter stands
  std::string request_sha256 = {};  // of a request's body; a model in this process gets none
  double latency_s = 0;
  int attempts = 1;
};

// One thread's. Fails (kPolicy, or kAnswered where asking again is of no use) when no answer came;
// what it did until then is in `failed_attempts`.
class Model {
 public:
  virtual ~Model() = default;
  virtual Result<Said> answer(const AskedQuery& asked) = 0;
  int failed_attempts = 1;
};

struct ModelTraits {
  std::string name;          // what rows call it, unless --name says otherwise
  std::string content;       // AskIdentity::content
  std::vector<Arm> arms;     // that make sense of it
  PictureRule picture = {};  // what it is shown
  bool is_shown = false;     // pictures are made into files for it
};

// Fails (kUsage, --model) on an unknown model, with the known ones and the nearest, and on options
// that it does not have; and where a certificate that is not there is to be accepted unchecked.
Result<ModelTraits> model_traits(std::string_view text, bool accepts_any_certificate = false);

// Fails (kUsage) where `name`, which rows call the model `model` (empty: one of the caller's), is
// none (check_row_name) or reads as a model of this process: their rows could not be told apart.
Status check_model_name(const std::string& name, const std::string& model);

// Of a model in this process; null for a server.
std::unique_ptr<Model> make_own_model(std::string_view text);

// One line each, for --help.
std::string model_help();

}  // namespace probe::ask
