// What success lacks of one clause, construct by construct: why it does not fit, to stand behind
// "says .. and"; nothing where it fits or nothing is certain.
#pragma once

#include <optional>
#include <string>

#include "compiler/check/clause_facts.h"
#include "compiler/check/clauses.h"

namespace probe::sema {

using Lack = std::optional<std::string>;

Lack put_lack(const ClauseFacts& facts, const Clause& clause);

// "take the cube off the tray" of which success is that it is there, and no later clause puts it
// back.
Lack from_lack(const ClauseFacts& facts, const Clause& clause);
// "put the cube on the table" of which success wants it to lie on the tray.
Lack ground_lack(const ClauseFacts& facts, const Clause& clause);
// "put the cube on the tray, then pick it up again" of which success is that it lies there at the
// end.
Lack taken_lack(const ClauseFacts& facts, const Clause& clause);
// "pick up the cube" and no more, of which success wants it to lie on the tray.
Lack place_left_out(const ClauseFacts& facts);

// "both cubes" of which success asks the same of three.
Lack count_lack(const ClauseFacts& facts, const Clause& clause);
// "open all drawers" of which success is that one is open; "one of the drawers" where it asks for
// all of them, or for a certain one; "the cube and the can" where either will do.
Lack quantity_lack(const ClauseFacts& facts, const Clause& clause);

// "open the drawer and close it" of which success asks that it is open, or nothing of it.
Lack joint_lack(const ClauseFacts& facts, const Clause& clause, const Clause::What& what);

// "do not put the cube on the tray" of which success is that it is there.
Lack denied_lack(const ClauseFacts& facts, const Clause& clause);

// "the cube last" of which success wants the cube first.
Lack rank_lack(const ClauseFacts& facts, const Rank& rank);

}  // namespace probe::sema
