(expect: missing-feed 2:5)
G01 X10
