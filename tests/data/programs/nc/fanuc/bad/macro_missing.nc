(expect: unknown-subprogram 2:1)
G65 P9999 A1
