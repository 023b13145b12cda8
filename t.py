import sys, dataclasses, tyro, time
@dataclasses.dataclass
class A:
    x: int = 1
@dataclasses.dataclass
class B:
    x: tuple[int, int] | None = None
@dataclasses.dataclass
class C:
    x: tuple[int, int] = (1,2)
@dataclasses.dataclass
class D:
    x: int | None = None
for K in (A,C,D,B):
    t=time.process_time(); tyro.cli(K,args=[]); print(K.__name__,'typeguard' in sys.modules, round(time.process_time()-t,3))
