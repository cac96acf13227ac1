import time, math, pytest, numpy as np
from wrist_control import WRISTS
from .physics_flown import *
@pytest.mark.parametrize('wrist', WRISTS)
def test_it(graph, wrist):
    t=time.time()
    f=PhysicsFlown(graph,wrist,payload=0.2)
    f.resolve()
    for man,ticks in (('basic_test',450),('stick',100)):
        done=f.fly(man,ticks)
        e=f.errors()
        print(wrist,man,done,len(e),f'{time.time()-t:.1f} s err',e[:,1:3].max(axis=0), 'at margin>.1',e[e[:,3]>.1][:,1:3].max(axis=0),'min margin',e[:,3].min(), f.status.message)
