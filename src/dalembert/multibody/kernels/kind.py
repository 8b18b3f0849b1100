"""Kinds of components: what one kind is to the rest of the package."""

from dataclasses import dataclass, field

from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled
from dalembert.kernels.lanes import Lanes
from dalembert.multibody.kernels import loops, nodes, pullbacks, tangents
from dalembert.multibody.kernels.debugging import PLAIN, PlainKernel
from dalembert.multibody.kernels.declaration import Declaration
from dalembert.multibody.kernels.loops import BlockKernel

_MAKERS = {**loops.MAKERS, **nodes.MAKERS, **tangents.MAKERS, "pullback": pullbacks.pullback}
_ONE_ARITHMETIC = {"tangent", "mean_tangent", "pullback"}  #: roles of which a kind has one kernel
_WHEN_NEEDED = {"mean", "mean_tangent", "mean_power"}  #: roles whose kernels are not compiled ahead


@dataclass(frozen=True, eq=False)
class Kind(Declaration):
    """A kind of component with its kernels. The parameters are those of its :class:`Declaration`."""

    _kernels: dict[tuple[str, type], BlockKernel] = field(default_factory=dict, init=False, repr=False)

    def kernel(self, role: str, dtype: type) -> Compiled:
        """The kernel of a role, such as residual, in real or in complex numbers."""
        if (role, dtype) not in self._kernels:
            self._kernels[role, dtype] = _MAKERS[role](self, dtype)
        kernel, errors = self._kernels[role, dtype], PLAIN.get().get(self)
        return kernel if errors is None else PlainKernel(kernel, errors)

    def vector_kernels(self) -> list[Compiled]:
        """The kernels in dual numbers and in lanes: a wheel has them, elsewhere they are compiled when needed."""
        taken = {Dual: ("residual", "rates", "restore"), Lanes: ("residual", "rates", "energy", "change", "restore")}
        known = [dtype for dtype, takes in ((Dual, self.takes_duals), (Lanes, self.takes_lanes)) if takes]
        return [self.kernel(role, dtype) for dtype in known for role in taken[dtype] if role in self.roles]

    def all_kernels(self) -> list[Compiled]:
        """The kernels of all roles that the kind has, in real and in complex numbers."""
        roles = [
            (role, dtype)
            for role in _MAKERS
            if role in self.roles and role not in _ONE_ARITHMETIC | _WHEN_NEEDED
            for dtype in (float, complex)
        ]
        pulled = self.is_flat and "pullback" in self.roles
        more = [("tangent", float)] * ("tangent" in self.roles) + [("pullback", complex)] * pulled
        return [self.kernel(*role) for role in (*roles, *more)]
