# For scripts that count by family of tasks: `family(TASK)`, in awk.
family='
  function family(task) {
    if (task ~ /^pick_horizontal/) return "can horizontal"
    if (task ~ /^pick_vertical/) return "can vertical"
    if (task ~ /^pick_standing/) return "can standing"
    if (task ~ /^pick_(full|denser)_/) return "full cans"
    if (task ~ /^pick_/) return "other things"
    if (task ~ /_near_/) return "move near"
    if (task ~ /^open_/) return "open"
    if (task ~ /^close_/) return "close"
    return "apple"
  }'
