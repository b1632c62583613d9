; expect: open-continuation 4:1
BEGIN PGM T MM
CYCL DEF 200 DRILLING ~
 Q200=2 ~