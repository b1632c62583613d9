(expect: bad-plane 3:1)
G00 A0.5
G68.3 X0 Y0 Z0
