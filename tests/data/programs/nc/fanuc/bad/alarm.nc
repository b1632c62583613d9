(expect: program-alarm 2:1)
#3000=1 (NO TOOL)
