import time
from lavendersim.engine.spec import Spec
from lavendersim.engine.solvers.packed.members import serve_for, shares_sweeps
s=Spec(effects=("friction","contact_torque","rotation","contact_rolling") if 0 else ("friction","contact_torque","rotation"),order="coloured",solver="coloured_gauss_seidel")
for _ in range(2):
    serve_for.cache_clear()
    t=time.perf_counter(); serve_for(s); print("serve", time.perf_counter()-t)
t=time.perf_counter()
from lavendersim.engine.solvers.packed.layout import allocate_packed
for _ in range(50): allocate_packed(s,3,16,True)
print("alloc small us",(time.perf_counter()-t)/50*1e6)
