(expect: endless-loop 3:1)
N10 #1=1
GOTO 10
