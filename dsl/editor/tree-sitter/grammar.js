// The grammar of Probe for tree-sitter: what dsl/grammar.ebnf says, in a form that editors parse at every keystroke.
// tests/dsl/tree_sitter_test.cpp holds it to the compiler: the same words and units, the same texts accepted, the same
// lines refused. src/ is generated from this file (README.md says how); src/scanner.c is written by hand and knows
// which line ends count.
//
// Words are special only where a rule asks for them. tree-sitter takes a word for a name wherever no rule that could
// go on here has it; where a rule has a word and a name as well, and what stands behind it decides, the word is also
// an `alias` of a name (`nameOr`).

// ---- shapes -----------------------------------------------------------------------------------------------------

// A line goes on behind what cannot end a statement.
const on = ($, sign) => seq(sign, optional($._on));
const list = ($, item) => seq(item, repeat(seq(on($, ','), item)));
const names = ($) => list($, $.identifier);
const things = ($) => list($, $.thing);
const points = ($) => list($, $.point);
const quantities = ($) => list($, $.quantity);
const integers = ($) => list($, $.integer);
const poses = ($) => list($, $.pose);

// `{ one; two }`: `inside` are statements with ends of lines between them.
const braced = ($, inside) => seq('{', optional($._ends), inside, '}');
const several = ($, item) => seq(item, repeat(seq($._ends, item)), optional($._ends));
const block = ($, item) => braced($, optional(several($, item)));
const parens = (inside) => seq('(', inside, ')');
const range = ($, item) => seq(item, on($, '..'), item);

// A name that may be one of `words`, although rules beside it ask for these.
const nameOr = ($, ...words) => choice($.identifier, ...words.map((word) => alias(word, $.identifier)));
const named = ($) => field('name', $.identifier);
const like = ($) => optional(seq('like', field('like', $.identifier)));
const against = ($) => optional(seq('against', field('against', $.identifier)));
const maybe = ($, word) => optional(seq(word, $.quantity));

// Operators of one precedence, from the left.
const chain = ($, self, word, operand) =>
  seq(field('left', self), field('operator', word), optional($._on), field('right', operand));
// Words that are operators end lines, as all words do.
const wordChain = (self, word, operand) =>
  seq(field('left', self), field('operator', word), field('right', operand));

// ---- what stands behind the first word of a statement, by the block it stands in ----------------------------------
// Blocks and words are those of compiler/syntax/keywords.def; statement `mesh` of an object is rule object_mesh.

const region = ($, owner) =>
  seq(named($), ...(owner ? ['of', field('of', $.identifier)] : []), 'box', range($, $.point),
      optional(seq('at', $.point, optional($.pose))));
const stand = ($) => seq('at', $.point, 'yaw', $.quantity);
const changes = ($) => block($, $._scene_statement);
const lamp = ($) => seq('power', $.quantity, maybe($, 'specular'), maybe($, 'ambient'));
const jointStart = ($, ...value) => choice(
    'none', seq(field('fixture', nameOr($, 'none')), on($, '.'), field('joint', $.identifier), choice('none', ...value)));
const numbers = ($) => choice($.quantity, $.point);
// A number, or the name of a binder in its place.
const count = ($) => choice($.integer, $.identifier);
const bound = ($) => choice($.quantity, $.identifier);
const drawn = ($) => seq('of', $._set_operand, 'seed', $.integer, optional(seq('with', 'baselines')));

const described = {  // what fixtures' parts have as objects do
  is: names,
  maybe: names,
  name: ($) => seq($.string, optional('bare')),
  phrase: ($) => seq(named($), field('axis', $.identifier), $.string, optional('bare'), 'means', $._query),
};

const statements = {
  dataset: {
    relations: ($) => list($, $.seen_on),
  },
  object: {
    mesh: ($) => $.string,
    box: ($) => choice(seq($.quantity, 'x', $.quantity, 'x', $.quantity), range($, $.point)),
    density: ($) => $.quantity,
    mass: ($) => seq($.quantity, optional(seq('com', $.point, 'inertia', $.point))),
    damping: ($) => seq($.quantity, optional(alias($._number_or_minus, $.quantity))),
    friction: ($) => $.quantity,
    scale: ($) => $.quantity,
    paint: ($) => choice($.identifier, $.point),
    texture: ($) => seq($.string, optional(alias($._number, $.quantity))),
    seen: ($) => seq('in', names($)),
    unseen: () => blank(),
    rest: poses,
    region: ($) => region($, false),
    ...described,
  },
  robot: {
    urdf: ($) => $.string,
    tcp: ($) => seq($.identifier, optional(seq('points', $.signed_axis))),
    fingers: ($) => choice('none', list($, $.finger)),
    control: ($) => seq(field('law', $.identifier), $.quantity, optional(block($, $._control_statement))),
    reach: ($) => range($, $.quantity),
    drive: ($) => seq(names($), maybe($, 'stiffness'), maybe($, 'damping'), maybe($, 'limit'),
                      maybe($, 'friction'), maybe($, 'armature')),
    grip: ($) => seq(range($, $.quantity), maybe($, 'friction'), maybe($, 'patch'), maybe($, 'pace'),
                     maybe($, 'stiffness'), maybe($, 'limit')),
  },
  control: {
    kp: numbers,
    damping: numbers,
    output: ($) => $.point,
    null: ($) => $.quantity,
    uncouple: () => blank(),
    ramp: ($) => $.quantity,
    home: ($) => $.point,
    from: ($) => $.identifier,
    most: ($) => $.quantity,
    arm_path: ($) => $.point,
    grip_path: ($) => $.point,
  },
  camera: {
    mount: ($) => seq($.path, 'at', $.point, choice('look', 'quat'), $.point),
    image: ($) => seq($.integer, 'x', $.integer, optional(seq('samples', $.integer))),
    lens: quantities,
    sensor: ($) => choice('none', repeat1(choice(
        seq(choice('noise', 'blur', 'exposure', 'dropped'), $.quantity), 'mirrored', seq('patch', range($, $.point))))),
    jitter: ($) => seq($.quantity, $.quantity),
  },
  light: {
    ambient: ($) => seq($.quantity, optional(seq('occlusion', $.integer))),
    sun: ($) => seq($.point, 'power', $.quantity, maybe($, 'specular'), optional('shadow')),
    spot: ($) => seq('at', $.point, 'along', $.point, lamp($), maybe($, 'cutoff'), maybe($, 'exponent'),
                     optional(seq('fade', $.point))),
    headlight: lamp,
    shading: () => 'vertex',
    color: ($) => $.point,
  },
  fixture: {
    urdf: ($) => $.string,
    at: ($) => seq($.point, optional($.pose)),
    friction: ($) => $.quantity,
    joint: ($) => seq($.identifier, maybe($, 'friction'), maybe($, 'damping'),
                      optional(seq('stiffness', $.quantity, 'at', $.quantity)), maybe($, 'armature'),
                      maybe($, 'start'), optional('stay')),
    part: ($) => seq(named($), 'link', field('link', $.identifier), optional(seq('name', $.string)),
                     optional(block($, $._part_statement))),
    region: ($) => seq(region($, true), optional(seq('name', $.string))),
    shown: ($) => seq(field('link', $.identifier), 'while', field('joint', $.identifier), choice('>=', '<='), $.quantity),
  },
  part: described,
  scene: {
    robot: ($) => choice(seq(nameOr($, 'at'), optional(stand($))), stand($)),
    joints: ($) => $.point,
    surface: ($) => seq($.quantity, 'area', range($, $.point)),
    texture: ($) => seq($.identifier, $.string, optional(alias($._number, $.quantity))),
    fixture: ($) => choice(seq($.string, 'at', $.point), names($)),
    region: ($) => region($, true),
    backdrop: ($) => seq($.string, optional('stands')),
    camera: ($) => list($, $.view),
    light: ($) => $.identifier,
    physics: ($) => seq($.quantity, 'friction', $.quantity, maybe($, 'air'), maybe($, 'viscosity'),
                        optional(seq('window', 'step'))),
  },
  layout: {
    cells: ($) => seq(named($), on($, '='), 'grid', $.integer, 'x', $.integer, 'at', $.point, 'spread', points($)),
    place: ($) => seq(names($), choice(
        seq('at', $.point),
        seq('on', $.thing),
        seq('in', choice(seq(choice('distinct', 'remaining'), field('cells', $.identifier)),
                         alias($._thing_in, $.thing))))),
    orient: ($) => choice(seq('by', 'rest'), seq(nameOr($, 'by'), poses($))),
    starts: ($) => $.string,
    jitter: ($) => $.quantity,
    joints: ($) => seq('jitter', $.quantity),
    start: ($) => jointStart($, $.quantity),
    drop: ($) => choice('none', seq($.quantity, maybe($, 'settle'))),
    expect: ($) => seq($.integer, 'episodes'),
  },
  task: {
    scene: ($) => choice(seq($.identifier, optional(changes($))), changes($)),
    layout: ($) => seq($.identifier, optional(seq('where', 'clear', list($, $.clear_phrase)))),
    source: ($) => $.thing,
    target: ($) => $.thing,
    metrics: ($) => $.identifier,
    light: ($) => $.identifier,
    camera: ($) => seq($.identifier, optional(seq('as', field('as', $.identifier)))),
    distractors: ($) => choice(
        'none', list($, $.thing), seq(alias($._none_thing, $.thing), on($, ','), list($, $.thing)),
        seq(count($), 'of', parens(names($)), 'seed', count($))),
    say: ($) => choice($.identifier, $.template),
    then: ($) => choice('none', seq('say', choice($.identifier, $.template), 'when', field('when', $._expression))),
    refer: ($) => seq(field('role', $.identifier), 'as', field('phrase', $.identifier)),
    pose: ($) => seq($.identifier, poses($)),
    start: ($) => jointStart($, $.quantity, $.identifier),
    horizon: ($) => choice(seq(count($), 'steps'), $.quantity, $.identifier),
    idle: ($) => seq(count($), 'steps'),
    delay: ($) => choice(seq(count($), 'steps'), $.quantity, $.identifier),
    moves: ($) => seq($.identifier, choice(
        'none',
        seq('along', points($), 'at', bound($), optional(choice('loop', 'once'))),
        seq('around', $.point, 'at', bound($)))),
    solution: ($) => choice('none', braced($, several($, $._solution_statement))),
    set: ($) => $.metric,
  },
  solution: {
    pick: ($) => $.thing,
    put: ($) => seq($.thing, choice('on', 'in', 'beside'), $.thing),
    open: ($) => $.thing,
    close: ($) => $.thing,
    turn: ($) => seq($.thing, choice('to', 'by'), $.quantity),
    press: ($) => $.thing,
    push: ($) => $.thing,
  },
  questions: {
    choice: ($) => question($, field('answer', $.identifier), 'among', $.pool),
    yesno: ($) => question($, field('answer', choice($.seen_answer, $._expression))),
    number: ($) => question($, 'count', parens(seq(field('attribute', $.identifier), 'of', $.identifier))),
    point: ($) => question($, field('answer', $.identifier)),
    free: ($) => question($, 'mentions', parens(seq($.identifier, on($, ','), $.identifier))),
  },
  suite: {
    tasks: ($) => $._task_set,
    sample: ($) => seq($.integer, 'episodes', drawn($)),
    prefix: ($) => $.string,
    seeds: integers,
    expect: ($) => seq($.integer, 'tasks', on($, ','), $.integer, 'episodes'),
    questions: names,
  },
  space: {
    light: ($) => list($, choice(seq(choice('ambient', 'power'), range($, $.quantity)), seq('direction', 'within', $.quantity))),
    camera: ($) => seq(field('view', $.identifier), 'within',
                       choice(seq($.point, optional(seq(on($, ','), $.quantity))), $.quantity)),
    place: ($) => list($, $.disc),
    clutter: ($) => seq(range($, $.integer), 'from', parens(names($))),
    words: ($) => list($, seq(choice('templates', 'phrases'), 'of', $.identifier)),
    sensor: ($) => list($, seq(choice('noise', 'blur', 'exposure'), range($, $.quantity))),
    delay: ($) => range($, $.quantity),
  },
};

const question = ($, ...answer) => seq(
    named($), alias($._question_text, $.template),
    optional(seq('for', field('binder', $.identifier), 'in', $.pool)),
    optional(seq('at', choice('start', 'end'))),
    'answer', ...answer,
    optional(seq('pixels', $.integer)), optional(seq('where', $._condition)));

// Of an object or a part any attribute may stand where no word of the table does, of a task any role.
const others = { object: 'attribute', part: 'attribute', task: 'role' };

// ---- declarations: rule task_declaration begins with `task` --------------------------------------------------------

const task = ($) => seq('task', named($), like($), against($), $.task_block);
const predicate = ($, ...words) => seq(
    named($), parens(optional(list($, $.parameter))), ...words, '=', optional($._ends), field('body', $._expression));

const declarations = {
  use: ($) => seq('use', $.string),
  dataset: ($) => seq('dataset', named($), $.string, optional(block($, $._dataset_statement))),
  attribute: ($) => seq('attribute', named($), $.name_set),
  facts: ($) => seq('facts', $.name_set),
  object: ($) => seq('object', named($), like($), block($, $._object_statement)),
  extend: ($) => seq('extend', 'object', field('object', $.identifier), block($, $._object_statement)),
  robot: ($) => seq('robot', named($), like($), block($, $._robot_statement)),
  camera: ($) => seq('camera', named($), like($), block($, $._camera_statement)),
  light: ($) => seq('light', named($), block($, $._light_statement)),
  fixture: ($) => seq('fixture', named($), like($), block($, $._fixture_statement)),
  scene: ($) => seq('scene', named($), like($), block($, $._scene_statement)),
  layout: ($) => seq('layout', named($), like($), block($, $._layout_statement)),
  role: ($) => seq('role', named($), optional(seq(on($, ':'), 'set'))),
  template: ($) => seq('template', named($), optional(seq('frame', field('frame', $.identifier))), $.template),
  predicate: ($) => seq('predicate', predicate($)),
  relation: ($) => seq('relation', predicate($, list($, $.string))),
  metrics: ($) => seq('metrics', named($), like($), block($, choice($.metric, $.ends))),
  abstract: ($) => seq('abstract', task($)),
  task,
  variant: ($) => seq('variant', named($), 'of', field('of', $.identifier), against($), $.task_block),
  variants: ($) => seq('variants', 'of', field('of', $.identifier), block($, $.member)),
  derive: ($) => seq('derive', field('name', $.template), 'for', list($, $.binder),
                     optional(seq('where', $._condition)), $.task_block),
  set: ($) => seq('set', named($), on($, '='), $._task_set),
  questions: ($) => seq('questions', named($), block($, $._questions_statement)),
  suite: ($) => seq('suite', named($), optional(seq('trained', 'on', field('trained_on', $.identifier))),
                    block($, $._suite_statement)),
  space: ($) => seq('space', named($), 'of', field('of', $.identifier), block($, $._space_statement)),
};

// ---- units: those of compiler/syntax/units.def ----------------------------------------------------------------------

const units = ['m', 'cm', 'mm', 's', 'ms', 'm/s', 'cm/s', 'Hz', 'kg/m3', 'kg', 'kgm2', 'Pas', 'N', 'Nm', 'N/m', 'Nm/rad',
               'Ns/m', 'Nms/rad', 'Ns', 'px', 'deg', 'rad'];

// ---- the two tables as rules ------------------------------------------------------------------------------------------

const rules = {};
for (const [word, rest] of Object.entries(declarations)) rules[`${word}_declaration`] = rest;
for (const [of, words] of Object.entries(statements)) {
  for (const [word, rest] of Object.entries(words)) rules[`${of}_${word}`] = ($) => seq(word, rest($));
  rules[`_${of}_statement`] = ($) => choice(
      ...Object.keys(words).map((word) => $[`${of}_${word}`]), ...(others[of] ? [$[others[of]]] : []));
}

module.exports = grammar({
  name: 'probe',
  word: ($) => $.identifier,

  // The scanner sees each token first. Brackets are its own, so that it knows whether it stands inside parentheses,
  // where line ends are blanks (`_blank_line`); braces around names change nothing there, those of blocks do. Elsewhere
  // a line end is a token: one that no rule takes is a mistake, as it is for the compiler.
  externals: ($) => [$._newline, $._blank_line, '(', ')', '{', '}', $._set_begin, $.text, $._characters],
  extras: ($) => [/[ \t\r]/, $._blank_line, $.comment, $.doc_comment],

  conflicts: ($) => [
    // Behind `x in 1,` stands a number of x or the next binder.
    [$.numbers],
  ],

  rules: {
    file: ($) => seq(optional($._ends), optional(several($, $._declaration))),

    _declaration: ($) => seq(repeat($.allow), choice(
        ...Object.keys(declarations).map((word) => word == 'abstract'
            ? alias($.abstract_declaration, $.task_declaration) : $[`${word}_declaration`]))),
    allow: ($) => seq(on($, '@'), 'allow', parens(seq($.identifier, on($, ','), $.string)), optional($._ends)),

    ...rules,

    // ---- lines ----
    _on: ($) => repeat1($._newline),
    _ends: ($) => repeat1(choice($._newline, ';')),
    comment: () => token(choice(/#(\r*[^#\r\n](\r*[^\r\n])*)?/, /###(\r*[^\r\n])*/)),
    doc_comment: () => token(/##(\r*[^#\r\n](\r*[^\r\n])*)?/),  // exactly two: of the next declaration

    // ---- the world ----
    attribute: ($) => seq(field('attribute', $.identifier), list($, field('value', $.identifier))),
    role: ($) => seq(field('role', $.identifier), choice('none', things($))),
    seen_on: ($) => seq(field('subject', $.identifier), field('preposition', $.identifier), field('object', $.identifier)),
    name_set: ($) => seq(alias($._set_begin, '{'), optional($._ends), names($), optional($._ends), '}'),
    thing_set: ($) => seq(alias($._set_begin, '{'), optional($._ends), things($), optional($._ends), '}'),
    path: ($) => seq($.identifier, repeat(seq(on($, '.'), $.identifier))),
    thing: ($) => seq($.identifier, optional(seq(on($, '.'), field('part', $.identifier)))),
    _none_thing: ($) => alias('none', $.identifier),  // an object that is called so, where others follow
    // Behind `in`, where `distinct` and `remaining` have a meaning.
    _thing_in: ($) => seq(nameOr($, 'distinct', 'remaining'), optional(seq(on($, '.'), field('part', $.identifier)))),
    point: ($) => parens(quantities($)),
    pose: ($) => repeat1($.angle),
    angle: ($) => seq(choice('roll', 'pitch', 'yaw'), $.quantity),
    signed_axis: ($) => seq(on($, choice('+', '-')), $.identifier),
    finger: ($) => seq(field('link', nameOr($, 'none')), 'opens', $.signed_axis),
    view: ($) => seq($.identifier, optional(seq('as', field('as', $.identifier))), optional(seq('overlay', $.string))),

    // ---- what is true of objects ----
    _query: ($) => choice(alias($._query_or, $.binary_query), $._query_and_up),
    _query_or: ($) => wordChain($._query, 'or', $._query_and_up),
    _query_and_up: ($) => choice(alias($._query_and, $.binary_query), $._query_one),
    _query_and: ($) => wordChain($._query_and_up, 'and', $._query_one),
    _query_one: ($) => choice($.not_query, $.parenthesized_query, $.fact, $.relation_query),
    not_query: ($) => seq('not', $._query_one),
    parenthesized_query: ($) => parens($._query),
    fact: ($) => seq($.identifier, optional(field('value', $.identifier))),
    relation_query: ($) => seq(field('relation', $.identifier), parens(names($))),

    // ---- expressions ----
    parameter: ($) => seq(named($), on($, ':'), field('type', choice(
        'object', 'body', 'part', 'region', 'length', 'angle', 'time', 'impulse', 'number')),
        optional(seq(on($, '='), field('default', $._expression)))),
    metric: ($) => seq(field('name', nameOr($, 'ends')), on($, '='), field('readout', $.readout), $._expression),
    readout: () => choice(seq('at', 'end'), 'once', 'always', 'count', 'times', 'first', 'final', 'max', 'min'),
    ends: ($) => seq('ends', 'when', $._expression),

    _expression: ($) => choice(alias($._or, $.binary), $._and_up),
    _or: ($) => wordChain($._expression, 'or', $._and_up),
    _and_up: ($) => choice(alias($._and, $.binary), $._not_up),
    _and: ($) => wordChain($._and_up, 'and', $._not_up),
    _not_up: ($) => choice(alias($._not, $.unary), $.condition_block, $.quantified, $.hold, $._compared),
    _not: ($) => seq(field('operator', choice('not', 'once', 'always')), $._not_up),
    condition_block: ($) => seq(choice('any', 'all'), braced($, several($, $._expression))),
    quantified: ($) => seq(choice('any', 'all', 'no'), field('variable', $.identifier), 'in', $._set, on($, ':'),
                           $._not_up),
    hold: ($) => seq($._compared, 'for', $.integer, 'steps'),
    _compared: ($) => choice(alias($._comparison, $.binary), $._sum_up),
    _comparison: ($) => chain($, $._sum_up, choice('<', '<=', '>', '>=', '==', '!='), $._sum_up),
    _sum_up: ($) => choice(alias($._sum, $.binary), $._product_up),
    _sum: ($) => chain($, $._sum_up, choice('+', '-'), $._product_up),
    _product_up: ($) => choice(alias($._product, $.binary), $._one),
    _product: ($) => chain($, $._product_up, choice('*', '/'), $._one),
    _one: ($) => choice(alias($._negated, $.unary), $.parenthesized, $.vector, alias($._number, $.quantity), $.member_of,
                        $.call, $._expression_name),
    _negated: ($) => seq(field('operator', '-'), optional($._on), $._one),
    parenthesized: ($) => parens($._expression),
    vector: ($) => parens(seq($._expression, on($, ','), $._expression, on($, ','), $._expression)),
    member_of: ($) => seq(field('owner', $._expression_name), on($, '.'), field('member', $.identifier)),
    call: ($) => seq(field('function', $._expression_name), parens(optional(list($, $.argument)))),
    argument: ($) => seq(optional(seq(field('name', $._argument_name), on($, ':'))), $._expression),
    _argument_name: ($) => nameOr($, 'any', 'all', 'no', 'present', 'left', 'nearer', 'not', 'once', 'always'),
    _expression_name: ($) => nameOr($, 'any', 'all', 'no', 'present', 'left', 'nearer'),

    // Sets of things.
    _set: ($) => choice($.binary_set, $._set_one),
    binary_set: ($) => chain($, $._set, choice('|', '&', '-'), $._set_one),
    _set_one: ($) => choice($.thing_set, $.parenthesized_set, $.whole, nameOr($, 'whole')),
    parenthesized_set: ($) => parens($._set),
    whole: ($) => seq('whole', $.thing),

    // ---- tasks ----
    task_block: ($) => block($, $._task_statement),
    member: ($) => seq(repeat($.allow), named($), $.task_block),
    disc: ($) => seq(field('what', $.identifier), 'in', 'disc', $.quantity),
    clear_phrase: ($) => seq(field('phrase', $.identifier), 'of', field('role', $.identifier)),

    binder: ($) => seq(named($), 'in', choice(
        seq(optional('clear'), 'phrases', field('axis', $.identifier), 'of', field('role', $.identifier)),
        prec(1, seq('templates', 'of', field('frame', $.identifier))),
        seq(choice('objects', 'parts'), parens(things($))),
        seq(choice('lights', 'cameras', 'scenes', 'robots', 'fixtures'), parens(names($))),
        $.numbers,
        seq(field('role', $._task_set_name), 'of', field('of', $.identifier)),
        $._set_operation)),
    numbers: ($) => choice(
        seq($._first_number, on($, '..'), $.quantity),
        seq($._first_number, repeat(seq(on($, ','), $._first_number)))),
    _first_number: ($) => alias($._number_or_minus, $.quantity),

    // Sets of tasks.
    _task_set: ($) => choice($._set_operation, $.where_set),
    where_set: ($) => seq($._set_operation, 'where', $._condition),
    _set_operation: ($) => choice(alias($._binary_task_set, $.binary_set), $._set_operand),
    _binary_task_set: ($) => chain($, $._set_operation, choice('|', '&', '-'), $._set_operand),
    _set_operand: ($) => choice($.name_set, alias($._parenthesized_task_set, $.parenthesized_set), $.variants_of, $.sample,
                                $._task_set_name),
    _parenthesized_task_set: ($) => parens($._task_set),
    variants_of: ($) => prec(1, seq('variants', 'of', $._set_operand)),
    sample: ($) => seq('sample', $.integer, drawn($)),
    _task_set_name: ($) => nameOr($, 'variants', 'sample', 'templates', 'phrases', 'clear', 'objects', 'parts', 'lights',
                                  'cameras', 'scenes', 'robots', 'fixtures'),

    _condition: ($) => choice(alias($._condition_or, $.binary_condition), $._condition_and_up),
    _condition_or: ($) => wordChain($._condition, 'or', $._condition_and_up),
    _condition_and_up: ($) => choice(alias($._condition_and, $.binary_condition), $._condition_one),
    _condition_and: ($) => wordChain($._condition_and_up, 'and', $._condition_one),
    _condition_one: ($) => choice($.not_condition, $.parenthesized_condition, $.condition),
    not_condition: ($) => seq('not', $._condition_one),
    parenthesized_condition: ($) => parens($._condition),
    condition: ($) => seq(choice('axis', 'uses', 'ood', 'has', 'scene', 'metrics'), $.path),

    // ---- questions ----
    pool: ($) => choice('catalogue', seq('objects', optional(seq('and', $.integer, 'absent')))),
    // What is read off the picture; any other call is one of a predicate.
    seen_answer: ($) => prec(1, choice(
        seq('present', parens($.identifier)),
        seq(choice('left', 'nearer'), parens(seq($.identifier, on($, ','), $.identifier))))),

    // ---- words and numbers ----
    identifier: () => /[A-Za-z][A-Za-z0-9_]*/,
    quantity: ($) => seq(optional(on($, choice('+', '-'))), $._number),
    _number_or_minus: ($) => seq(optional(on($, '-')), $._number),
    _number: ($) => seq(choice($.integer, $.float), optional(choice($.unit, $.unknown_unit))),
    integer: () => /[0-9]+/,
    float: () => /[0-9]+(\.[0-9]+([eE][+-]?[0-9]+)?|[eE][+-]?[0-9]+)/,
    unit: () => token.immediate(prec(1, choice(...units))),
    // The compiler says what is wrong with it, and goes on.
    unknown_unit: () => token.immediate(prec(1, /[A-Za-z_][A-Za-z0-9_]*(\/[A-Za-z][A-Za-z0-9_]*)?/)),

    // ---- strings ----
    // `text` of templates stands between slots, `_characters` have braces, too; both are the scanner's, so that text
    // is not looked for outside of strings when tree-sitter goes on after a mistake.
    string: ($) => seq('"', repeat(choice(alias($._characters, $.text), $.escape)), alias($._string_end, '"')),
    template: ($) => seq('"', repeat(choice($.text, $.escape, $.slot)), alias($._string_end, '"')),
    _question_text: ($) => seq('"', repeat(choice($.text, $.escape, $.placeholder)), alias($._string_end, '"')),
    _string_end: () => token.immediate('"'),
    escape: () => token.immediate(/\\["\\n]/),
    // Its braces are no brackets of the scanner's.
    _slot_begin: () => token.immediate(prec(1, '{')),
    _slot_end: () => /\}/,
    slot: ($) => seq(
        alias($._slot_begin, '{'), optional('avoid'),
        choice(seq(optional('the'), optional(choice('both', seq('all', optional($.number_word))))), seq('the', 'other')),
        field('name', nameOr($, 'avoid', 'the', 'both', 'all', 'other')),
        optional(seq('.', field('part', $.identifier))), optional(seq(':', field('category', $.identifier))),
        alias($._slot_end, '}')),
    number_word: () => choice('two', 'three', 'four', 'five', 'six', 'seven', 'eight', 'nine', 'ten', 'eleven', 'twelve'),
    placeholder: ($) => seq(
        alias($._slot_begin, '{'), optional(choice('the', 'a')), field('name', nameOr($, 'the', 'a')),
        optional(seq('of', field('of', $.identifier))), alias($._slot_end, '}')),
  },
});
