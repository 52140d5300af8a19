function result = limcycle_df (what, varargin)
% LIMCYCLE_DF  Describing functions of a friction law or element.
%   RESULT = LIMCYCLE_DF (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('df', what, varargin{:});
end
