(expect: modal-conflict 3:1)
G51 X0 Y0 Z0 P2.
G51.1 X0
