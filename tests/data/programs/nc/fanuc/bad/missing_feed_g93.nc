(expect: missing-feed 3:1)
G93 G01 X10 F2
X20
