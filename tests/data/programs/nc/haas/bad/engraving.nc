(expect: unsupported-word 2:1)
G47 P0 X2. Y2. I0. J.5 R.05 Z-.005 F15. E10. (TEXT)
M30
