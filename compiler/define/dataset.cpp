// `dataset`: the relations that a training set has.
#include "compiler/define/define.h"

namespace probe::sema {

void define_datasets(Context& context) {
  for (const auto& declared : context.symbols.dataset_decls) {
    Dataset dataset{std::string(declared.node->name.text), declared.node->title.value, {}};
    for (const syntax::RelationsStmt& stmt : declared.node->body) {
      for (const syntax::Relation& relation : stmt.relations) {
        const auto subject = context.symbols.objects.find(relation.subject, context.diagnostics);
        const auto object = context.symbols.objects.find(relation.object, context.diagnostics);
        if (!subject || !object) continue;
        dataset.relations.push_back(
            {static_cast<ObjectId>(*subject), static_cast<ObjectId>(*object)});
      }
    }
    context.model.datasets.add(std::move(dataset));
  }
}

}  // namespace probe::sema
