# Sourced by campaigns over verbs that write, in the folder that they work in; they set $vlaprobe and $here.
#   verbs_begin          makes what the verbs begin with: suite.plan, odd and even (halves of a run), calm.run
#   start VERB OUTPUT    becomes that call; OUTPUT.h5 is the file of `table`
#   content VERB OUTPUT  what two outputs that are equal have in common
verbs=(run sweep merge ask table dataset)
few=(--tasks carrot_on_plate --episodes 0-5)
start() {
  case $1 in
    run) exec "$vlaprobe" run suite.plan "${few[@]}" --policy expert --jobs 2 -o "$2" ;;
    sweep) exec "$vlaprobe" sweep suite.plan "${few[@]}" --policy 'weak:ambient<{}' --checkpoints 0.1,0.5 -o "$2" ;;
    merge) exec "$vlaprobe" merge odd even -o "$2" ;;
    ask) exec "$vlaprobe" ask "$here/suite/questions.probe" --tasks '*carrot_on_plate' --episodes 0-1 --model random -o "$2" ;;
    table) exec "$vlaprobe" export calm.run -o "$2.h5" ;;
    dataset) exec "$vlaprobe" export calm.run --format lerobot --size 64x48 -o "$2" ;;
  esac
}
rows_of() { "$vlaprobe" results "$1" --csv | sed 's/[^,]*\.trace//'; }  # without where traces lie
content() {
  case $1 in
    run | merge) rows_of "$2" ;;
    sweep) for part in "$2"/0.1 "$2"/0.5; do rows_of "$part"; done ;;
    ask) "$vlaprobe" results "$2" --json | grep -v '"latency_s"' ;;
    table) sha256sum <"$2.h5" ;;
    dataset) (cd "$2" && find . -type f -print0 | sort -z | xargs -0 sha256sum) ;;
  esac
}
verbs_begin() {
  local share part
  "$vlaprobe" build "$here/suite/intact.probe" -o suite.plan >/dev/null
  for share in odd even; do
    [ "$share" = odd ] && part=1/2 || part=2/2
    "$vlaprobe" run suite.plan "${few[@]}" --policy expert --shard "$part" -o "$share" >log 2>&1
  done
  (start run calm.run) >log 2>&1
}
