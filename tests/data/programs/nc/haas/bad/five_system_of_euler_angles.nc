(expect: out-of-range 3:33)
G00 X0. Y0. Z50. A0. C0.
G268 X0. Y0. Z0. I10. J20. K30. Q131
M30
