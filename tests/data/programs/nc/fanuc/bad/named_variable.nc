(expect: bad-number 2:7)
G00 X#<x>
