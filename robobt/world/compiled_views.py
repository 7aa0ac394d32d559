"""Views of an array as records in compiled code, without functions of numba's own for each type of record.

Numba checks by a function, which it compiles for each pair of types, whether an array may be viewed as
another type; its messages take a second more. Here the check is two instructions.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant
from numba.core import cgutils, types
from numba.core.imputils import impl_ret_borrowed
from numba.extending import lower_builtin
from numba.np.arrayobj import array_view, make_array


@lower_builtin("array.view", types.Array, types.DType)  # type: ignore[no-untyped-call, untyped-decorator]
def view_as_records(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Generate ``array.view(dtype)``; anything but numbers viewed as records is left to numba.

    The compiled code raises ValueError if the last axis does not hold a whole number of records, or not
    without gaps.

    Args:
        context: numba's, of the machine.
        builder: writes the instructions.
        sig: the types of array, dtype and result.
        args: the values of array and dtype.
    """
    source, made = sig.args[0], sig.return_type
    if source.ndim == 0 or isinstance(source.dtype, types.Record) or not isinstance(made.dtype, types.Record):
        return array_view(context, builder, sig, args)
    index_type = context.get_value_type(types.intp)
    number, record = (
        Constant(index_type, context.get_abi_sizeof(context.get_data_type(kind)))
        for kind in (source.dtype, made.dtype)
    )
    array, result = make_array(source)(context, builder, args[0]), make_array(made)(context, builder)  # type: ignore[no-untyped-call]
    shape = cgutils.unpack_tuple(builder, array.shape, source.ndim)  # type: ignore[no-untyped-call]
    strides = cgutils.unpack_tuple(builder, array.strides, source.ndim)  # type: ignore[no-untyped-call]
    width = builder.mul(shape[-1], number)
    refused = builder.icmp_signed("!=", builder.srem(width, record), Constant(index_type, 0))
    if source.layout != "C":
        gaps = builder.icmp_signed("!=", strides[-1], number)
        several = builder.icmp_signed(">", array.nitems, Constant(index_type, 1))
        refused = builder.or_(refused, builder.and_(gaps, several))
    with builder.if_then(refused, likely=False):
        message = "the array's last axis does not hold records of that type"
        context.call_conv.return_user_exc(builder, ValueError, (message,))
    shape[-1], strides[-1] = builder.sdiv(width, record), record
    result.meminfo, result.parent = array.meminfo, array.parent
    result.nitems, result.itemsize = builder.sdiv(builder.mul(array.nitems, number), record), record
    result.data = builder.bitcast(array.data, result.data.type)
    result.shape, result.strides = cgutils.pack_array(builder, shape), cgutils.pack_array(builder, strides)  # type: ignore[no-untyped-call]
    return impl_ret_borrowed(context, builder, made, result._getvalue())  # type: ignore[no-untyped-call]
