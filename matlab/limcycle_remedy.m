function result = limcycle_remedy (what, varargin)
% LIMCYCLE_REMEDY  What ends hunting, and what it costs.
%   RESULT = LIMCYCLE_REMEDY (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('remedy', what, varargin{:});
end
