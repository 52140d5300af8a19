function result = limcycle_dissipativity (what, varargin)
% LIMCYCLE_DISSIPATIVITY  Whether friction and loop are passive and bounded.
%   RESULT = LIMCYCLE_DISSIPATIVITY (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('dissipativity', what, varargin{:});
end
