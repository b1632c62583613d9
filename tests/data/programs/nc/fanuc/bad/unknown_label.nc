(expect: unknown-label 2:1)
GOTO 100
